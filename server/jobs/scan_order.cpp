// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scan_order.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "acquisition/session/scan_request.h"
#include "server/jobs/clock.h"
#include "server/jobs/order_fields.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

std::string title_of(const ScanOrder& order, std::int64_t created) {
  const bool is_blank = order.metadata.title.find_first_not_of(' ') == std::string::npos;
  if (!is_blank) return order.metadata.title;
  return fmt::format("Scan of {:%Y-%m-%d %H:%M}",
                     fmt::gmtime(static_cast<std::time_t>(created / 1000)));
}

constexpr double kLeastExposure = 1;  // shortest exposure, in microseconds

void read_length(Fields& fields, const Json& body, int& length) {
  const auto found = body.find("length");
  if (found == body.end()) return;
  const bool fits = found->is_number_integer() &&
                    std::ranges::find(acquisition::kSamplingLengths, found->get<std::int64_t>()) !=
                        acquisition::kSamplingLengths.end();
  if (!fits)
    return fields.fault("length",
                        fmt::format("one of {}", fmt::join(acquisition::kSamplingLengths, ", ")));
  length = found->get<int>();
}

void read_processing(Fields& fields, const Json& body, acquisition::Processing& processing) {
  auto& [stripe, sampling, surface] = processing;
  fields.choice("stripe", acquisition::kStripeNames, stripe.method);
  fields.choice("sampling", acquisition::kSamplingNames, sampling.method);
  read_length(fields, body, sampling.window);
  fields.real("largest_angle", 0, acquisition::kMostAngle, surface.largest_angle);
  fields.real("largest_hole", 0, acquisition::kMostHole, surface.largest_hole);
}

void read_model(Fields& fields, const Json& body, ScanOrder& order, FieldFaults& faults) {
  fields.whole("calibration", 1, acquisition::kMostCalibration, order.calibration);
  read_processing(fields, body, order.request.processing);
  read_bits(fields, body, order.bits);
  fields.choice("placement", kPlacementNames, order.placement);
  read_metadata(fields, body, order.metadata, faults);
  fields.flag("publish", order.is_public);
  fields.text("webhook", order.webhook);
}

void read_scan(Fields& fields, const Json& body, ScanOrder& order) {
  fields.text("scanner", order.scanner);
  if (!body.contains("scanner")) fields.fault("scanner", "the name of one of /api/v1/scanners");
  fields.whole("steps", acquisition::kLeastSteps, acquisition::kMostSteps, order.request.steps);
  fields.real("exposure", kLeastExposure, acquisition::kMostExposure, order.request.exposure_us);
  fields.flag("keep_frames", order.request.keeps_frames);
}

// Names of the allowed fields. kOfScan applies to a new scan only, kOfModel to a new scan and to a
// rebuild.
constexpr std::string_view kOfScan[] = {"scanner", "steps", "exposure", "keep_frames"};
constexpr std::string_view kOfModel[] = {"calibration",   "stripe",       "sampling", "length",
                                         "largest_angle", "largest_hole", "bits",     "placement",
                                         "metadata",      "publish",      "webhook"};

std::vector<std::string_view> names(std::initializer_list<std::span<const std::string_view>> sets) {
  std::vector<std::string_view> all;
  for (const auto set : sets)
    all.insert(all.end(), set.begin(), set.end());
  return all;
}

}  // namespace

tl::expected<ScanOrder, FieldFaults> parse_scan_order(const Json& body) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ScanOrder order;
  fields.only(names({kOfScan, kOfModel}));
  read_scan(fields, body, order);
  read_model(fields, body, order, faults);
  return order_or_faults(std::move(order), std::move(faults));
}

tl::expected<ScanOrder, FieldFaults> parse_reprocess_order(const Json& body,
                                                           const ScanOrder& scan) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ScanOrder order = scan;
  fields.only(names({kOfModel}));
  read_model(fields, body, order, faults);
  order.is_public_as_before = order.is_public_as_before && !body.contains("publish");
  return order_or_faults(std::move(order), std::move(faults));
}

tl::expected<CalibrationOrder, FieldFaults> parse_calibration_order(const Json& body) {
  constexpr std::string_view kKnown[] = {"poses", "webhook"};
  FieldFaults faults;
  Fields fields(body, "", faults);
  CalibrationOrder order;
  fields.only(kKnown);
  fields.whole("poses", kLeastPoses, kMostPoses, order.poses);
  fields.text("webhook", order.webhook);
  return order_or_faults(std::move(order), std::move(faults));
}

std::string to_json_text(const CalibrationOrder& order) {
  return Json{{"poses", order.poses}, {"webhook", order.webhook}}.dump();
}

tl::expected<ScanOrder, FieldFaults> parse_kept_order(const Json& kept) {
  FieldFaults faults;
  Fields fields(kept, "", faults);
  ScanOrder order;
  fields.only(names({kOfScan, kOfModel}));
  read_scan(fields, kept, order);
  read_model(fields, kept, order, faults);
  order.is_public_as_before = !kept.contains("publish");
  return order_or_faults(std::move(order), std::move(faults));
}

std::string to_json_text(const ScanOrder& order) {
  const auto& [stripe, sampling, surface] = order.request.processing;
  Json json = {{"scanner", order.scanner},
               {"steps", order.request.steps},
               {"keep_frames", order.request.keeps_frames},
               {"stripe", acquisition::kStripeNames[static_cast<std::size_t>(stripe.method)]},
               {"sampling", acquisition::kSamplingNames[static_cast<std::size_t>(sampling.method)]},
               {"length", sampling.window},
               {"largest_angle", surface.largest_angle},
               {"largest_hole", surface.largest_hole},
               {"bits", order.bits},
               {"placement", kPlacementNames[static_cast<std::size_t>(order.placement)]},
               {"metadata", to_json(order.metadata)}};
  if (!order.is_public_as_before) json["publish"] = order.is_public;
  if (!order.webhook.empty()) json["webhook"] = order.webhook;
  if (order.request.exposure_us) json["exposure"] = *order.request.exposure_us;
  if (order.calibration > 0) json["calibration"] = order.calibration;
  return json.dump();
}

Expected<ScanOrder> stored_scan_order(const std::string& parameters) {
  const auto json = Json::parse(parameters, nullptr, /*allow_exceptions=*/false);
  auto order = parse_kept_order(json.is_object() ? json : Json::object());
  if (order) return *order;
  return fail(ErrorCode::kState, fmt::format("the scan's parameters are damaged at {}; scan again",
                                             order.error().front().field));
}

CalibrationOrder stored_calibration_order(const std::string& parameters) {
  const auto json = Json::parse(parameters, nullptr, /*allow_exceptions=*/false);
  return parse_calibration_order(json.is_object() ? json : Json::object())
      .value_or(CalibrationOrder{});
}

ScanEntry new_scan(ScanOrder order) {
  ScanEntry scan;
  scan.id = ScanId::generate();
  scan.created = now_in_milliseconds();
  order.metadata.title = title_of(order, scan.created);
  scan.scanner = order.scanner;
  scan.is_public = order.is_public;
  scan.title = order.metadata.title;
  scan.parameters = to_json_text(order);
  scan.steps = order.request.steps;
  return scan;
}

}  // namespace vitrine::server
