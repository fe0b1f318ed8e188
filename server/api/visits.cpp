// SPDX-License-Identifier: Apache-2.0
// Counts visits to published models, and shows the counts to operators. A viewer reports how long
// its model was visible and the finest level that it showed. The server keeps only sums for each
// model and day: no address, cookie or user agent, and nothing about a single visit.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/published.h"
#include "server/messages/download_name.h"
#include "server/messages/timestamp.h"

namespace vitrine::server {
namespace {

using std::chrono::days;
using std::chrono::sys_days;
using VisitFaults = std::vector<ParameterFault>;

constexpr std::uint32_t kMaxSeconds = 86'400;  // longest time that one report may state
constexpr days kDefaultDays{30};
// Largest number of rows of a CSV file. It limits the memory needed to build the file.
constexpr std::uint32_t kMaxRows = 100'000;

// A viewer's report. A visit has several reports if its page was hidden and shown again.
struct VisitReport {
  std::uint32_t seconds = 0;              // time since the previous report of this visit
  std::uint32_t level = 0;                // the finest level shown so far in this visit
  std::optional<std::uint32_t> previous;  // `level` of the previous report; nullopt: a new visit
};

// Reads a whole number from 0 to `most`. If it is missing or invalid, adds a fault.
std::uint32_t read_whole(const Query& query, const char* name, std::uint32_t most,
                         VisitFaults& faults) {
  const auto value = parse_number<std::uint32_t>(query.get(name).value_or(""));
  if (value && *value <= most) return *value;
  faults.push_back({name, fmt::format("a whole number from 0 to {}", most)});
  return 0;
}

// Reads a viewer's report from the query. `finest` is the number of the model's finest level.
tl::expected<VisitReport, Response> read_report(const Request& request, std::uint32_t finest) {
  constexpr std::string_view kKnown[] = {"seconds", "level", "previous"};
  const auto query = read_query(request, kKnown);
  if (!query) return tl::unexpected(query.error());
  VisitFaults faults;
  VisitReport report;
  report.seconds = read_whole(*query, "seconds", kMaxSeconds, faults);
  report.level = read_whole(*query, "level", finest, faults);
  if (query->get("previous"))
    report.previous = read_whole(*query, "previous", report.level, faults);
  if (faults.empty()) return report;
  return tl::unexpected(problem(400, "a parameter is out of range", request.id, faults));
}

// Returns the counts that the report adds to the model's sums.
VisitCounts counts_of(const VisitReport& report, std::uint32_t finest) {
  const bool was_complete = report.previous && *report.previous == finest;
  return {.visits = report.previous ? 0u : 1u,
          .seconds = report.seconds,
          .levels = report.level - report.previous.value_or(0),
          .complete = report.level == finest && !was_complete ? 1u : 0u};
}

sys_days today() {
  return std::chrono::floor<days>(std::chrono::system_clock::now());
}

std::string format_date(sys_days day) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

// Reads the dates `from` and `to` from the query. The default is the last kDefaultDays days.
tl::expected<DayRange, Response> read_days(const Request& request) {
  constexpr std::string_view kKnown[] = {"from", "to"};
  constexpr const char* kDate = "a date such as 2026-11-28";
  const auto query = read_query(request, kKnown);
  if (!query) return tl::unexpected(query.error());
  VisitFaults faults;
  const auto read = [&](const char* name, sys_days otherwise) {
    const auto text = query->get(name);
    auto day = text ? parse_date(*text) : otherwise;
    if (day && *day < sys_days()) day = std::nullopt;  // no visits were counted before 1970
    if (!day) faults.push_back({name, kDate});
    return day.value_or(otherwise);
  };
  const sys_days last = read("to", today());
  const DayRange range{read("from", last - kDefaultDays + days(1)), last};
  if (faults.empty() && range.first > range.last) faults.push_back({"from", "not after `to`"});
  if (faults.empty()) return range;
  return tl::unexpected(problem(400, "a parameter is out of range", request.id, faults));
}

double mean_level(const VisitCounts& counts) {
  if (counts.visits == 0) return 0;
  return static_cast<double>(counts.levels) / static_cast<double>(counts.visits);
}

// Quotes a text for a CSV file [RFC4180]. Spreadsheet programs run a cell that begins with one of
// "=+-@" as a formula, so such a text gets an apostrophe.
std::string csv_text(std::string_view text) {
  std::string cell = "\"";
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos)
    cell += '\'';
  for (const char c : text)
    cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

std::string csv_row(const DayVisits& row) {
  const VisitCounts& counts = row.of.counts;
  return fmt::format("{},{},{},{},{},{:.2f},{}\r\n", format_date(row.day), row.of.model.to_string(),
                     csv_text(row.of.title), counts.visits, counts.seconds, mean_level(counts),
                     counts.complete);
}

nlohmann::ordered_json visits_json(const ModelVisits& of) {
  return {{"model", of.model.to_string()},       {"title", of.title},
          {"visits", of.counts.visits},          {"seconds", of.counts.seconds},
          {"mean_level", mean_level(of.counts)}, {"complete", of.counts.complete}};
}

}  // namespace

static Response count_visit(const Request& request, Services& services) {
  if (!services.settings.get().counts_visits)
    return problem(404, "this server does not count visits", request.id);
  const ModelId id = id_in<ModelId>(request);
  // Looks the model up as a visitor sees it, even if the caller has a token: only visits to public
  // levels are counted.
  const VisibleModel visible = find_visible(id, /*has_token=*/false, services.models);
  return with_found(visible.model, request, services, [&](const auto& model) {
    const auto finest = static_cast<std::uint32_t>(model->manifest().levels.size() - 1);
    const auto report = read_report(request, finest);
    if (!report) return report.error();
    services.visits.count({id, today()}, counts_of(*report, finest));
    Response response;
    response.status = 204;
    return response;
  });
}

static Response list_visits(const Request& request, Services& services) {
  const auto range = read_days(request);
  if (!range) return range.error();
  const auto visits = services.visits.flushed();
  if (!visits) return internal_error(visits.error(), request, services);
  const auto found = (*visits)->by_model(*range, kMostListed);
  if (!found) return internal_error(found.error(), request, services);
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ModelVisits& of : *found)
    all.push_back(visits_json(of));
  return json_answer({{"from", format_date(range->first)},
                      {"to", format_date(range->last)},
                      {"counted", services.settings.get().counts_visits},
                      {"models", std::move(all)}});
}

static Response save_visits(const Request& request, Services& services) {
  const auto range = read_days(request);
  if (!range) return range.error();
  const auto visits = services.visits.flushed();
  if (!visits) return internal_error(visits.error(), request, services);
  const auto found = (*visits)->by_day(*range, kMaxRows + 1);
  if (!found) return internal_error(found.error(), request, services);
  if (found->size() > kMaxRows) {
    return problem(400, fmt::format("these days have more than {} rows; ask for fewer", kMaxRows),
                   request.id);
  }
  std::string text = "day,model,title,visits,seconds,mean_level,complete\r\n";
  for (const DayVisits& row : *found)
    text += csv_row(row);
  Response response;
  response.type = "text/csv; charset=utf-8";
  response.fields = {{"Content-Disposition",
                      attachment_named(fmt::format("visits {} {}", format_date(range->first),
                                                   format_date(range->last)),
                                       "visits", "csv")}};
  response.body = std::move(text);
  return response;
}

static constexpr std::string_view kVisitsComponents = R"json({
"parameters": {
  "visitSeconds": {"name": "seconds", "in": "query", "required": true,
    "description": "Seconds in which the model was visible, since the visit's previous report",
    "schema": {"type": "integer", "minimum": 0, "maximum": 86400}},
  "visitLevel": {"name": "level", "in": "query", "required": true, "description": "The finest level that the visit has shown so far",
    "schema": {"type": "integer", "minimum": 0}},
  "visitPrevious": {"name": "previous", "in": "query", "description": "`level` of the visit's previous report; missing in the first report",
    "schema": {"type": "integer", "minimum": 0}},
  "fromDay": {"name": "from", "in": "query", "description": "The first day, in UTC; by default 29 days before `to`",
    "schema": {"type": "string", "format": "date"}},
  "toDay": {"name": "to", "in": "query", "description": "The last day, in UTC; by default today",
    "schema": {"type": "string", "format": "date"}}
},
"schemas": {
  "Visits": {"type": "object", "required": ["from", "to", "counted", "models"], "properties": {
    "from": {"type": "string", "format": "date"}, "to": {"type": "string", "format": "date"},
    "counted": {"type": "boolean", "description": "Whether the server counts visits now"},
    "models": {"type": "array", "description": "The most visited first; at most 10,000", "items": {"type": "object",
      "required": ["model", "title", "visits", "seconds", "mean_level", "complete"], "properties": {
      "model": {"$ref": "#/components/schemas/Id"}, "title": {"type": "string"}, "visits": {"type": "integer"},
      "seconds": {"type": "integer", "description": "Time in which the model was visible, in all visits together"},
      "mean_level": {"type": "number", "description": "Mean of the finest level that each visit reached"},
      "complete": {"type": "integer", "description": "Visits that reached the model's finest level"}}}}}}
}
})json";

static constexpr ApiRoute kVisitRoutes[] = {
    {.method = Method::kPost,
     .path = "/api/v1/models/{id}/visits",
     .handler = count_visit,
     .executor = Executor::kWorker,
     .doc = {.id = "countVisit",
             .summary = "Counts a visit to a published model, or more time of a visit. Only sums "
                        "for each model and day are kept.",
             .parameters = "visitSeconds visitLevel visitPrevious",
             .status = 204}},
    {.method = Method::kGet,
     .path = "/api/v1/visits",
     .handler = list_visits,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "listVisits",
             .summary = "Returns the visits to each model over some days.",
             .parameters = "fromDay toDay",
             .response = "Visits"}},
    {.method = Method::kGet,
     .path = "/api/v1/visits.csv",
     .handler = save_visits,
     .executor = Executor::kWorker,
     .role = Role::kViewer,
     .doc = {.id = "saveVisits",
             .summary =
                 "Returns the visits to each model on each day as CSV, at most 100,000 rows.",
             .parameters = "fromDay toDay",
             .response = "text/csv"}},
};

static constexpr ApiTag kVisitsTags[] = {
    {.name = "visits", .description = "Visits to published models, as sums for each day."}};

const ApiNoun kVisits = {
    .routes = kVisitRoutes, .components = kVisitsComponents, .tags = kVisitsTags};

}  // namespace vitrine::server
