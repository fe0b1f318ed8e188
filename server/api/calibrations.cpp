// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "server/api/forward.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

nlohmann::ordered_json summary_json(const CalibrationSummary& one) {
  return {{"number", one.number},
          {"created", one.created},
          {"camera", one.camera},
          {"region",
           {{"x", one.region.x},
            {"y", one.region.y},
            {"width", one.region.width},
            {"height", one.region.height}}},
          {"rms", one.rms},
          {"p95", one.p95},
          {"max", one.max},
          {"coverage", one.coverage}};
}

// Returns a response with `file`, the text of a file of a calibration. Returns 404 if `file` is
// nullopt, which means that the calibration does not exist.
Response file_answer(const Expected<std::optional<std::string>>& file, const char* type,
                     const Request& request, Services& services) {
  if (!file) return internal_error(file.error(), request, services);
  if (!*file) return problem(404, "there is no such calibration", request.id);
  Response response;
  response.type = type;
  response.body = **file;
  return response;
}

}  // namespace

static Response list_calibrations(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto all = scanner.backend().calibrations();
    if (!all) return internal_error(all.error(), request, services);
    auto whole = nlohmann::ordered_json::array(), damaged = nlohmann::ordered_json::array();
    for (const CalibrationSummary& one : *all) {
      if (one.problem.empty()) {
        whole.push_back(summary_json(one));
      } else {
        damaged.push_back({{"number", one.number}, {"problem", one.problem}});
      }
    }
    return json_answer({{"calibrations", std::move(whole)}, {"damaged", std::move(damaged)}});
  });
}

static Response start_calibration(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto order = parse_calibration_order(request.body);
    if (!order) return invalid(order.error(), request);
    if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
      return invalid(faults, request);
    const auto once = idempotency_key(request);
    if (!once) return once.error();
    const auto job = services.scans.calibrate(scanner, *order, *once);
    if (!job) return refused_job(job.error(), request, services);
    Response response = json_answer({{"job", job->id.to_string()}}, 202);
    response.fields = {{"Location", "/api/v1/jobs/" + job->id.to_string()}};
    return response;
  });
}

static Response show_calibration(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto number = static_cast<int>(number_in(request));
    return file_answer(scanner.backend().calibration_report(number), "application/json", request,
                       services);
  });
}

static Response show_residuals(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto number = static_cast<int>(number_in(request));
    return file_answer(scanner.backend().residual_plot(number), "image/svg+xml", request, services);
  });
}

static constexpr std::string_view kCalibrationsComponents = R"json({
"parameters": {
  "path.number": {"name": "number", "in": "path", "required": true,
    "schema": {"type": "integer", "minimum": 1, "maximum": 999999}}
},
"schemas": {
  "CalibrationOrder": {"type": "object", "additionalProperties": false, "properties": {
    "poses": {"type": "integer", "minimum": 3, "maximum": 200, "default": 20}, "webhook": {"$ref": "#/components/schemas/Webhook"}}},
  "CalibrationList": {"type": "object", "required": ["calibrations", "damaged"], "properties": {
    "calibrations": {"type": "array", "items": {"type": "object", "required": ["number", "rms"], "properties": {
      "number": {"type": "integer"}, "created": {"type": "string"}, "camera": {"type": "string"}, "region": {"type": "object"},
      "rms": {"type": "number", "description": "RMS residual in mm over held-out poses"}, "p95": {"type": "number"}, "max": {"type": "number"}, "coverage": {"type": "number"}}}},
    "damaged": {"type": "array", "items": {"type": "object", "properties": {"number": {"type": "integer"}, "problem": {"type": "string"}}}}}},
  "CalibrationReport": {"type": "object", "required": ["number", "camera", "residuals_mm"]}
}
})json";

static constexpr ApiRoute kCalibrationRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/scanners/{name}/calibrations",
     .handler = list_calibrations,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "listCalibrations",
             .summary = "Lists a scanner's calibrations, newest first.",
             .response = "CalibrationList"}},
    {.method = Method::kPost,
     .path = "/api/v1/scanners/{name}/calibrations",
     .handler = start_calibration,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "startCalibration",
             .summary = "Starts a calibration job.",
             .parameters = "idempotencyKey",
             .request = "CalibrationOrder",
             .status = 202,
             .response = "JobStarted"}},
    {.method = Method::kGet,
     .path = "/api/v1/scanners/{name}/calibrations/{number}",
     .handler = show_calibration,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "getCalibration",
             .summary = "Returns a calibration's report.",
             .response = "CalibrationReport"}},
    {.method = Method::kGet,
     .path = "/api/v1/scanners/{name}/calibrations/{number}/residuals.svg",
     .handler = show_residuals,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "getResiduals",
             .summary = "Returns a plot of a calibration's residuals.",
             .response = "image/svg+xml"}},
};

const ApiNoun kCalibrations = {.routes = kCalibrationRoutes, .components = kCalibrationsComponents};

}  // namespace vitrine::server
