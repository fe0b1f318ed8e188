// SPDX-License-Identifier: Apache-2.0
#include "server/api/job_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "server/api/published.h"
#include "server/messages/http_header.h"
#include "server/messages/timestamp.h"
#include "server/metadata/text.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kKinds[] = {"scan", "calibrate", "reprocess", "publish"};
constexpr std::string_view kScannerStates[] = {"idle", "busy", "unreachable"};
constexpr std::string_view kLaserStates[] = {"unknown", "off", "on"};
constexpr std::string_view kMotorStates[] = {"unknown", "off", "holding", "turning"};
constexpr std::size_t kMaxKey = 200;

template <class Tag>
Json id_or_null(const std::optional<Id<Tag>>& id) {
  return id ? Json(id->to_string()) : Json(nullptr);
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json number_or_null(const auto& number) {
  return number ? Json(*number) : Json(nullptr);
}

std::string_view state_of_scan(const JobRecord& job) {
  if (job.state == JobState::kQueued) return "waiting";
  if (job.state != JobState::kRunning) return kJobStates[static_cast<std::size_t>(job.state)];
  return job.stage.empty() ? std::string_view("waiting") : std::string_view(job.stage);
}

std::span<const std::uint8_t> text_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Json rows_json(const std::optional<ScannedRows>& rows) {
  if (!rows) return nullptr;
  return {{"empty", rows->empty}, {"saturated", rows->saturated}, {"doubled", rows->doubled}};
}

// Returns the state of a laser or a motor, and the time at which it entered that state. The time is
// null if the state has never been known.
Json power_json(std::string_view state, acquisition::BoardPower::Clock::time_point since) {
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(since.time_since_epoch()).count();
  return {{"state", state},
          {"since", milliseconds == 0 ? Json(nullptr) : Json(timestamp(milliseconds))}};
}

}  // namespace

JobStatus without_reasons(JobStatus job) {
  if (!job.record.error.empty()) job.record.error = "send a token to see why";
  if (!job.note.empty()) job.note = "waiting for the scanner";
  job.record.repairs.clear();
  return job;
}

Json job_json(const JobStatus& job) {
  const JobRecord& record = job.record;
  return {{"id", record.id.to_string()},
          {"kind", kKinds[static_cast<std::size_t>(record.kind)]},
          {"state", kJobStates[static_cast<std::size_t>(record.state)]},
          {"stage", text_or_null(record.stage)},
          {"progress", record.progress},
          {"eta", number_or_null(job.eta)},
          {"error", text_or_null(record.error)},
          {"note", text_or_null(job.note)},
          {"scanner", text_or_null(record.scanner)},
          {"scan", id_or_null(record.scan)},
          {"model", id_or_null(record.model)},
          {"repairs", lines_of(record.repairs)},
          {"created", timestamp(record.created)},
          {"ended", record.ended == 0 ? Json(nullptr) : Json(timestamp(record.ended))}};
}

Json scan_json(const ScanInfo& scan) {
  const ScanEntry& entry = scan.entry;
  const JobRecord& job = scan.job.record;
  const int calibration = entry.calibration;
  return {{"id", entry.id.to_string()},
          {"job", entry.job.to_string()},
          {"scanner", entry.scanner},
          {"state", state_of_scan(job)},
          {"step", entry.step},
          {"steps", entry.steps},
          {"progress", job.progress},
          {"eta", number_or_null(scan.job.eta)},
          {"error", text_or_null(job.error)},
          {"note", text_or_null(scan.job.note)},
          {"calibration", calibration == 0 ? Json(nullptr) : Json(calibration)},
          {"points", entry.points},
          {"rows", rows_json(entry.rows)},
          {"model", id_or_null(entry.model)},
          {"title", entry.title},
          {"created", timestamp(entry.created)}};
}

Json scanner_json(const ScannerStatus& scanner) {
  const acquisition::BoardPower& power = scanner.power;
  Json json = {{"id", scanner.name},
               {"name", scanner.name},
               {"state", kScannerStates[static_cast<std::size_t>(scanner.state)]},
               {"camera", nullptr},
               {"board", nullptr},
               {"calibration", nullptr},
               {"scan", id_or_null(scanner.scan)},
               {"problem", text_or_null(scanner.problem)}};
  json["laser"] =
      power_json(kLaserStates[static_cast<std::size_t>(power.laser)], power.laser_since);
  json["motor"] =
      power_json(kMotorStates[static_cast<std::size_t>(power.motor)], power.motor_since);
  if (const auto& seen = scanner.identity) {
    json["camera"] = {{"vendor", seen->camera.vendor},
                      {"model", seen->camera.model},
                      {"serial", seen->camera.serial}};
    json["board"] = {{"dialect", seen->board.dialect}, {"firmware", seen->board.firmware}};
    json["calibration"] = number_or_null(seen->calibration);
  }
  return json;
}

Response json_answer(const Json& json, unsigned status) {
  Response response;
  response.status = status;
  response.type = "application/json";
  // Replaces invalid UTF-8, because the JSON may contain text from a device.
  response.body = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return response;
}

Response refused(const Error& error, const Request& request, Services& services) {
  if (error.code == ErrorCode::kState) return problem(409, error.message, request.id);
  if (error.code == ErrorCode::kBadInput) return problem(422, error.message, request.id);
  if (error.code != ErrorCode::kLimit) return internal_error(error, request, services);
  tell_operator(error, request.id, services);
  return problem(507, error.message, request.id);
}

Response refused_job(const Error& error, const Request& request, Services& services) {
  if (error.code != ErrorCode::kBadInput) return refused(error, request, services);
  return problem(422, error.message, request.id,
                 {{"Idempotency-Key", "a new key, or the request that first used this key"}});
}

Response invalid(const FieldFaults& faults, const Request& request) {
  std::vector<ParameterFault> errors;
  for (const FieldFault& fault : faults)
    errors.push_back({fault.field, fault.detail});
  return problem(422, "a field of the body is missing, unknown or out of range", request.id,
                 errors);
}

tl::expected<std::optional<IdempotencyKey>, Response> idempotency_key(const Request& request) {
  const auto found = request.header.find("Idempotency-Key");
  if (found == request.header.end()) return std::nullopt;
  const std::string key(found->value());
  const bool printable = std::ranges::all_of(key, [](char c) { return c > 0x20 && c < 0x7F; });
  if (key.empty() || key.size() > kMaxKey || !printable) {
    return tl::unexpected(
        problem(422, "the Idempotency-Key is malformed", request.id,
                {{"Idempotency-Key", fmt::format("1 to {} printable characters", kMaxKey)}}));
  }
  const std::string caller = request.caller ? request.caller->token.to_string() : "";
  const std::string about = fmt::format("{}\n{}", request.path, request.body.dump());
  return IdempotencyKey{fmt::format("{} {}", caller, key), sha256(text_bytes(about))};
}

tl::expected<Query, Response> read_query(const Request& request,
                                         std::span<const std::string_view> known) {
  auto query = Query::parse(request.query);
  if (!query) return tl::unexpected(problem(400, "the query is malformed", request.id));
  const auto unknown = query->unknown(known);
  if (!unknown) return std::move(*query);
  return tl::unexpected(problem(400, "a parameter is unknown", request.id,
                                {{std::string(*unknown), "unknown here"}}));
}

template <class Id>
tl::expected<PageOf<Id>, std::vector<ParameterFault>> read_page(const Query& query) {
  PageOf<Id> page;
  std::vector<ParameterFault> faults;
  if (const auto limit = query.get("limit")) {
    const auto [end, fault] =
        std::from_chars(limit->data(), limit->data() + limit->size(), page.limit);
    if (fault != std::errc{} || end != limit->data() + limit->size() || page.limit < 1 ||
        page.limit > kMaxPage) {
      faults.push_back({"limit", fmt::format("a whole number from 1 to {}", kMaxPage)});
    }
  }
  if (const auto cursor = query.get("cursor")) {
    page.after = Id::parse(*cursor);
    if (!page.after) faults.push_back({"cursor", "the 'next' of the page before"});
  }
  if (!faults.empty()) return tl::unexpected(std::move(faults));
  return page;
}

template <class Id>
tl::expected<PageOf<Id>, Response> read_page(const Request& request) {
  constexpr std::string_view kKnown[] = {"limit", "cursor"};
  const auto query = read_query(request, kKnown);
  if (!query) return tl::unexpected(query.error());
  auto page = read_page<Id>(*query);
  if (page) return *page;
  return tl::unexpected(problem(400, "a parameter is out of range", request.id, page.error()));
}

template tl::expected<PageOf<ModelId>, std::vector<ParameterFault>> read_page(const Query&);
template tl::expected<PageOf<JobId>, Response> read_page(const Request&);
template tl::expected<PageOf<ScanId>, Response> read_page(const Request&);
template tl::expected<PageOf<TokenId>, Response> read_page(const Request&);

void link_next(const std::optional<std::string>& cursor, const Request& request,
               Response& response) {
  if (!cursor) return;
  std::string target(request.path);
  target += '?';
  for (std::string_view left = request.query; !left.empty();) {
    const std::string_view parameter = left.substr(0, left.find('&'));
    left.remove_prefix(std::min(left.size(), parameter.size() + 1));
    if (!parameter.starts_with("cursor=")) target.append(parameter) += '&';
  }
  response.fields.emplace_back("Link", fmt::format("<{}cursor={}>; rel=\"next\"", target, *cursor));
}

Response list_answer(std::string_view name, Json items, const std::optional<std::string>& cursor,
                     const Request& request) {
  Json json = {{std::string(name), std::move(items)}, {"next", nullptr}};
  if (cursor) json["next"] = *cursor;
  Response response = json_answer(json);
  link_next(cursor, request, response);
  return response;
}

Response token_needed(const Request& request) {
  Response response = problem(401, "send a token: Authorization: Bearer TOKEN", request.id);
  response.fields = {{"WWW-Authenticate", "Bearer"}};
  return response;
}

}  // namespace vitrine::server
