// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/api/forward.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/messages/query.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kMaxPoints = 250'000;  // largest number of points in one response

// Calls `answer(scan)` with the scan that the request names, or forwards the request to the daemon
// that drives the scan's scanner. Returns 401 or 404 if there is no scan that the caller may see,
// and 500 or 503 if an error occurs.
template <class Answer>
Response with_scan(const Request& request, Services& services, Answer&& answer) {
  const auto scan = services.scans.find(id_in<ScanId>(request));
  if (!scan) return internal_error(scan.error(), request, services);
  if (*scan) {
    if (const auto address = forward_address((*scan)->entry.scanner, request, services))
      return forward(*address, request, services);
  }
  if (*scan && request.caller) return for_caller(answer(**scan));
  if (*scan && is_visible(**scan, services.models))
    return answer(ScanInfo{(*scan)->entry, without_reasons((*scan)->job)});
  // Returns 401 for every ID, so that the response does not reveal which scans exist.
  if (!request.caller) return token_needed(request);
  return problem(404, "there is no such scan", request.id);
}

// Returns the scans as a JSON array. If another daemon runs a scan, asks that daemon, because the
// catalogue lacks the remaining time and the reason for which the scan waits. If that daemon does
// not respond, uses the catalogue.
nlohmann::ordered_json told(std::span<const ScanInfo> scans, const Request& request,
                            Services& services) {
  auto list = nlohmann::ordered_json::array();
  std::vector<DaemonQuery> questions;
  std::vector<std::size_t> asked;  // for each query, the index of its scan in `list`
  for (const ScanInfo& scan : scans) {
    list.push_back(scan_json(scan));
    if (has_ended(scan.job.record.state)) continue;
    const auto address = forward_address(scan.entry.scanner, request, services);
    if (!address) continue;
    asked.push_back(list.size() - 1);
    questions.push_back({*address, "/api/v1/scans/" + scan.entry.id.to_string(), ""});
  }
  auto answers = ask_daemons(questions, request, services);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i].is_null()) list[asked[i]] = std::move(answers[i]);
  }
  return list;
}

Response started(const ScanStarted& scan) {
  Response response =
      json_answer({{"id", scan.scan.to_string()}, {"job", scan.job.to_string()}}, 202);
  response.fields = {{"Location", "/api/v1/jobs/" + scan.job.to_string()}};
  return response;
}

Response state_after(const Expected<void>& done, const ScanId& id, const Request& request,
                     Services& services) {
  if (!done) return refused(done.error(), request, services);
  const auto scan = services.scans.find(id);
  if (!scan || !*scan) return problem(404, "there is no such scan", request.id);
  // Responds with 202 (Accepted), because the command takes effect at the turntable's next step.
  return json_answer(scan_json(**scan), 202);
}

std::optional<std::size_t> read_from(const Query& query) {
  return parse_number<std::size_t>(query.get("from").value_or("0"));
}

// Whether the calibration that the order names exists. Returns true if this daemon does not drive
// the scanner and so cannot check; the job then reports a missing calibration.
bool knows_calibration(const ScanOrder& order, Services& services) {
  ScannerStation* scanner = services.scans.scanner(order.scanner);
  if (order.calibration == 0 || scanner == nullptr) return true;
  const auto report = scanner->backend().calibration_report(order.calibration);
  return !report || *report;
}

Response unknown_calibration(const Request& request) {
  return invalid({{"calibration", "the number of one of the scanner's calibrations"}}, request);
}

std::string little_endian(std::span<const std::array<float, 3>> points) {
  static_assert(std::endian::native == std::endian::little);
  return {reinterpret_cast<const char*>(points.data()), points.size_bytes()};
}

}  // namespace

static Response start_scan(const Request& request, Services& services) {
  const auto order = parse_scan_order(request.body);
  if (!order) return invalid(order.error(), request);
  if (const auto address = forward_address(order->scanner, request, services))
    return forward(*address, request, services);
  if (services.scans.scanner(order->scanner) == nullptr)
    return invalid({{"scanner", "the name of one of /api/v1/scanners"}}, request);
  if (!knows_calibration(*order, services)) return unknown_calibration(request);
  if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
    return invalid(faults, request);
  const auto once = idempotency_key(request);
  if (!once) return once.error();
  const auto scan = services.scans.scan(*order, *once);
  return scan ? started(*scan) : refused_job(scan.error(), request, services);
}

static Response list_scans(const Request& request, Services& services) {
  const auto page = read_page<ScanId>(request);
  if (!page) return page.error();
  const auto scans = services.scans.list(*page);
  if (!scans) return internal_error(scans.error(), request, services);
  std::optional<std::string> next;
  if (scans->size() == page->limit) next = scans->back().entry.id.to_string();
  return list_answer("scans", told(*scans, request, services), next, request);
}

static Response show_scan(const Request& request, Services& services) {
  return with_scan(request, services,
                   [](const ScanInfo& scan) { return json_answer(scan_json(scan)); });
}

static Response show_points(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    constexpr std::string_view kKnown[] = {"from"};
    const auto query = read_query(request, kKnown);
    if (!query) return query.error();
    const auto from = read_from(*query);
    if (!from)
      return problem(400, "a parameter is out of range", request.id,
                     {{"from", "a whole number, 0 or more"}});
    const auto view = services.scans.view(scan.entry);
    if (!view) return refused(view.error(), request, services);
    Response response;
    response.type = "application/octet-stream";
    if (*view) {
      auto points = (*view)->points_from(*from);
      points.resize(std::min(points.size(), kMaxPoints));
      response.body = little_endian(points);
    }
    return response;
  });
}

static Response show_profile(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    const auto view = services.scans.view(scan.entry);
    if (!view) return refused(view.error(), request, services);
    auto points = nlohmann::ordered_json::array();
    if (*view) points = (*view)->profile();
    return json_answer(points);
  });
}

static Response pause_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    return state_after(services.scans.pause(scan.entry), scan.entry.id, request, services);
  });
}

static Response resume_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    return state_after(services.scans.resume(scan.entry), scan.entry.id, request, services);
  });
}

static Response is_limited(const Request& request) {
  return problem(409,
                 "public_max_level limits the scan's model; reprocess without publish, then limit "
                 "and publish the new model, whose levels differ",
                 request.id);
}

static Response reprocess_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    auto before = ScanService::order_of(scan.entry);
    if (!before) return refused(before.error(), request, services);
    const bool is_whole = scan.entry.step == scan.entry.steps,
               has_model = scan.entry.model.has_value();
    // These defaults apply if the order does not say whether to publish. The model of an incomplete
    // scan becomes a draft. A model that replaces another model becomes public if visitors could
    // see all of the replaced model.
    before->is_public = before->is_public && is_whole && !has_model;
    before->is_public_as_before = is_whole && has_model;
    const auto order = parse_reprocess_order(request.body, *before);
    if (!order) return invalid(order.error(), request);
    if (order->is_public && has_model) {
      const auto model = services.catalogue.find(*scan.entry.model);
      if (!model) return refused(model.error(), request, services);
      if (*model && (*model)->public_part) return is_limited(request);
    }
    if (!knows_calibration(*order, services)) return unknown_calibration(request);
    if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
      return invalid(faults, request);
    const auto once = idempotency_key(request);
    if (!once) return once.error();
    const auto job = services.scans.reprocess(scan.entry, *order, *once, request.caller->token);
    return job ? started(*job) : refused_job(job.error(), request, services);
  });
}

static Response remove_scan_data(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    if (const auto removed = services.scans.remove_data(scan.entry); !removed)
      return refused(removed.error(), request, services);
    Response response;
    response.status = 204;
    return response;
  });
}

static constexpr std::string_view kScansComponents = R"json({
"parameters": {
  "from": {"name": "from", "in": "query", "description": "Index of the first point to return",
    "schema": {"type": "integer", "minimum": 0, "default": 0}}
},
"schemas": {
  "Processing": {"type": "object", "properties": {
    "calibration": {"type": "integer", "minimum": 1, "description": "Number of the calibration; the newest by default"},
    "stripe": {"enum": ["derivative-of-gaussian", "centre-of-mass", "blais-rioux"]},
    "sampling": {"enum": ["adaptive", "paper", "equidistant"]}, "length": {"enum": [5, 10, 15, 20], "default": 5},
    "largest_angle": {"type": "number", "minimum": 0}, "largest_hole": {"type": "number", "minimum": 0, "description": "mm"},
    "bits": {"anyOf": [{"const": "auto"}, {"const": 0}, {"type": "integer", "minimum": 10, "maximum": 16}], "default": "auto"},
    "placement": {"enum": ["midpoint", "pyramid"]}, "metadata": {"$ref": "#/components/schemas/Metadata"},
    "publish": {"type": "boolean", "description": "Whether to publish the model; otherwise it stays a draft"}, "webhook": {"$ref": "#/components/schemas/Webhook"}}},
  "ScanOrder": {"required": ["scanner"], "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/Processing"}],
    "type": "object", "properties": {
    "publish": {"default": false}, "scanner": {"type": "string", "description": "The scanner's name"}, "steps": {"type": "integer", "default": 720},
    "exposure": {"type": "number", "minimum": 1, "description": "Exposure time in microseconds; the scanner's own setting by default"},
    "keep_frames": {"type": "boolean", "default": false}}},
  "ReprocessOrder": {"type": "object", "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/Processing"}],
    "description": "Options not given keep the values used by the scan. Without `publish`, the new model is public if visitors see the whole model before it. If `public_max_level` limits that one, the new model must be a draft"},
  "ScanStarted": {"type": "object", "required": ["id", "job"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "job": {"$ref": "#/components/schemas/Id"}}},
  "Scan": {"type": "object", "required": ["id", "job", "scanner", "state", "step", "steps", "progress", "eta", "error", "note", "points", "model", "title", "created"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "job": {"$ref": "#/components/schemas/Id"}, "scanner": {"type": "string"},
      "state": {"enum": ["waiting", "scanning", "paused", "meshing", "building", "done", "failed", "cancelled"]},
      "step": {"type": "integer"}, "steps": {"type": "integer"}, "progress": {"type": "number", "minimum": 0, "maximum": 1},
      "eta": {"type": ["number", "null"], "description": "Remaining time in seconds"}, "error": {"type": ["string", "null"]},
      "note": {"type": ["string", "null"], "description": "The event or resource that the scan waits for"}, "calibration": {"type": ["integer", "null"]},
      "points": {"type": "integer"}, "rows": {"type": ["object", "null"]}, "model": {"$ref": "#/components/schemas/IdOrNull"},
      "title": {"type": "string"}, "created": {"$ref": "#/components/schemas/Time"}}},
  "ScanPage": {"type": "object", "required": ["scans", "next"], "properties": {
    "scans": {"type": "array", "items": {"$ref": "#/components/schemas/Scan"}}, "next": {"$ref": "#/components/schemas/Next"}}},
  "Profile": {"type": "array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
    "description": "rho and z of each point in mm"}
}
})json";

static constexpr ApiRoute kScanRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/scans",
     .handler = list_scans,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "listScans",
             .summary = "Lists the scans, newest first.",
             .parameters = "limit cursor",
             .response = "ScanPage"}},
    {.method = Method::kPost,
     .path = "/api/v1/scans",
     .handler = start_scan,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "startScan",
             .summary = "Starts a scan. The result is a draft or a published model.",
             .parameters = "idempotencyKey",
             .request = "ScanOrder",
             .status = 202,
             .response = "ScanStarted"}},
    // The routes below need no token. Their handlers let every client watch a scan that will be
    // public.
    {.method = Method::kGet,
     .path = "/api/v1/scans/{id}",
     .handler = show_scan,
     .executor = Executor::kWorker,
     .doc = {.id = "getScan",
             .summary = "Returns a scan's state and progress.",
             .response = "Scan"}},
    {.method = Method::kGet,
     .path = "/api/v1/scans/{id}/points",
     .handler = show_points,
     .executor = Executor::kWorker,
     .doc = {.id = "getPoints",
             .summary =
                 "Returns the points measured so far: x, y and z in mm as little-endian float32.",
             .parameters = "from",
             .response = "application/octet-stream"}},
    {.method = Method::kGet,
     .path = "/api/v1/scans/{id}/profile",
     .handler = show_profile,
     .executor = Executor::kWorker,
     .doc = {.id = "getProfile", .summary = "Returns the latest profile.", .response = "Profile"}},
    {.method = Method::kPost,
     .path = "/api/v1/scans/{id}/pause",
     .handler = pause_scan,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "pauseScan",
             .summary = "Pauses a scan after its current step.",
             .request = "Nothing",
             .is_request_optional = true,
             .status = 202,
             .response = "Scan"}},
    {.method = Method::kPost,
     .path = "/api/v1/scans/{id}/resume",
     .handler = resume_scan,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "resumeScan",
             .summary = "Resumes a paused, interrupted or failed scan.",
             .request = "Nothing",
             .is_request_optional = true,
             .status = 202,
             .response = "Scan"}},
    {.method = Method::kPost,
     .path = "/api/v1/scans/{id}/reprocess",
     .handler = reprocess_scan,
     .executor = Executor::kWorker,
     .role = Role::kOperator,
     .doc = {.id = "reprocessScan",
             .summary = "Rebuilds the mesh of a stored scan. Options not given keep the values "
                        "used by the scan.",
             .parameters = "idempotencyKey",
             .request = "ReprocessOrder",
             .status = 202,
             .response = "ScanStarted"}},
    {.method = Method::kDelete,
     .path = "/api/v1/scans/{id}/data",
     .handler = remove_scan_data,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "removeScanData",
             .summary = "Deletes a scan's profiles, points and pictures permanently. Its record "
                        "and its models stay.",
             .status = 204}},
};

static constexpr ApiTag kScansTags[] = {
    {.name = "scans", .description = "Finished and running scans, from which models are made."}};

const ApiNoun kScans = {.routes = kScanRoutes, .components = kScansComponents, .tags = kScansTags};

}  // namespace vitrine::server
