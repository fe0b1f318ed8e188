// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"
#include "server/http/scanner_of.h"

namespace vitrine {
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

// A file of a calibration that is never changed.
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

Response list_calibrations(const Request& request, Services& services) {
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

Response start_calibration(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto order = parse_calibration_order(request.body);
    if (!order) return invalid(order.error(), request);
    if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
      return invalid(faults, request);
    const auto once = once_key(request);
    if (!once) return once.error();
    const auto job = services.scans.calibrate(scanner, *order, *once);
    if (!job) return refused_job(job.error(), request, services);
    Response response = json_answer({{"job", job->id.to_string()}}, 202);
    response.fields = {{"Location", "/api/v1/jobs/" + job->id.to_string()}};
    return response;
  });
}

Response show_calibration(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto number = static_cast<int>(request.parameters.number);
    return file_answer(scanner.backend().calibration_report(number), "application/json", request,
                       services);
  });
}

Response show_residuals(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto number = static_cast<int>(request.parameters.number);
    return file_answer(scanner.backend().residual_plot(number), "image/svg+xml", request, services);
  });
}

}  // namespace vitrine
