// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/http/elsewhere.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"
#include "server/http/query.h"

namespace vitrine {
namespace {

constexpr std::size_t kMaxPoints = 250'000;  // of one answer

// Calls `answer(scan)` with the request's scan, has the daemon answer that drives its scanner, or
// answers 401, 404 or 500.
template <class Answer>
Response with_scan(const Request& request, Services& services, Answer&& answer) {
  const auto scan = services.scans.find(request.parameters.id);
  if (!scan) return internal_error(scan.error(), request, services);
  if (*scan) {
    if (const auto address = elsewhere((*scan)->entry.scanner, request, services))
      return ask_elsewhere(*address, request, services);
  }
  if (*scan && request.caller) return for_caller(answer(**scan));
  if (*scan && is_public((*scan)->entry, services))
    return answer(ScanInfo{(*scan)->entry, without_reasons((*scan)->job)});
  if (!request.caller) return token_needed(request);  // which scans there are is nobody's business
  return problem(404, "there is no such scan", request.id);
}

// Each as the daemon tells that drives its scanner, where it goes on elsewhere and that one
// answers: only it knows how long the scan will take, and what it waits for.
nlohmann::ordered_json told(std::span<const ScanInfo> scans, const Request& request,
                            Services& services) {
  auto list = nlohmann::ordered_json::array();
  std::vector<Question> questions;
  std::vector<std::size_t> asked;  // which of the list
  for (const ScanInfo& scan : scans) {
    list.push_back(scan_json(scan));
    if (has_ended(scan.job.record.state)) continue;
    const auto address = elsewhere(scan.entry.scanner, request, services);
    if (!address) continue;
    asked.push_back(list.size() - 1);
    questions.push_back({*address, "/api/v1/scans/" + scan.entry.id.to_string(), ""});
  }
  auto answers = ask_all(questions, request, services);
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
  return json_answer(scan_json(**scan), 202);  // it takes effect at the next step
}

std::optional<std::size_t> read_from(const Query& query) {
  return parse_number<std::size_t>(query.get("from").value_or("0"));
}

// Of a scanner that is not configured any more nothing is known: the job will say so.
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

Response start_scan(const Request& request, Services& services) {
  const auto order = parse_scan_order(request.body);
  if (!order) return invalid(order.error(), request);
  if (const auto address = elsewhere(order->scanner, request, services))
    return ask_elsewhere(*address, request, services);
  if (services.scans.scanner(order->scanner) == nullptr)
    return invalid({{"scanner", "the name of one of /api/v1/scanners"}}, request);
  if (!knows_calibration(*order, services)) return unknown_calibration(request);
  if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
    return invalid(faults, request);
  const auto once = once_key(request);
  if (!once) return once.error();
  const auto scan = services.scans.scan(*order, *once);
  return scan ? started(*scan) : refused_job(scan.error(), request, services);
}

Response list_scans(const Request& request, Services& services) {
  const auto page = read_page(request);
  if (!page) return page.error();
  const auto scans = services.scans.list(*page);
  if (!scans) return internal_error(scans.error(), request, services);
  nlohmann::ordered_json json = {{"scans", told(*scans, request, services)}, {"next", nullptr}};
  if (scans->size() == page->limit) json["next"] = scans->back().entry.id.to_string();
  return json_answer(json);
}

Response show_scan(const Request& request, Services& services) {
  return with_scan(request, services,
                   [](const ScanInfo& scan) { return json_answer(scan_json(scan)); });
}

Response show_points(const Request& request, Services& services) {
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

Response show_profile(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    const auto view = services.scans.view(scan.entry);
    if (!view) return refused(view.error(), request, services);
    auto points = nlohmann::ordered_json::array();
    if (*view) points = (*view)->profile();
    return json_answer(points);
  });
}

Response pause_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    return state_after(services.scans.pause(scan.entry), scan.entry.id, request, services);
  });
}

Response resume_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    return state_after(services.scans.resume(scan.entry), scan.entry.id, request, services);
  });
}

Response reprocess_scan(const Request& request, Services& services) {
  return with_scan(request, services, [&](const ScanInfo& scan) {
    auto before = ScanService::order_of(scan.entry);
    if (!before) return refused(before.error(), request, services);
    const bool is_whole = scan.entry.step == scan.entry.steps;
    before->publish = before->publish && is_whole;  // half an object: where that is said anew
    const auto order = parse_reprocess_order(request.body, *before);
    if (!order) return invalid(order.error(), request);
    if (!knows_calibration(*order, services)) return unknown_calibration(request);
    if (const auto faults = check_webhook(order->webhook, services); !faults.empty())
      return invalid(faults, request);
    const auto once = once_key(request);
    if (!once) return once.error();
    const auto job = services.scans.reprocess(scan.entry, *order, *once);
    return job ? started(*job) : refused_job(job.error(), request, services);
  });
}

}  // namespace vitrine
