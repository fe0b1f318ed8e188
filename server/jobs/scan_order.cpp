// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scan_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "acquisition/session/scan_request.h"
#include "codec/progressive/manifest.h"
#include "server/store/text.h"

namespace vitrine {
namespace {

using Json = nlohmann::json;

constexpr double kLeastExposure = 1;  // microseconds
constexpr std::size_t kMaxTextBytes = 4096;
constexpr std::string_view kPlacements[] = {"midpoint", "pyramid"};

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text;
}

// Reads the members of one object; what is absent or wrong stays as it was.
class Fields {
 public:
  Fields(const Json& object, std::string prefix, FieldFaults& faults)
      : object_(object), prefix_(std::move(prefix)), faults_(faults) {}

  void only(std::span<const std::string_view> known) {
    for (const auto& [name, value] : object_.items()) {
      if (std::ranges::find(known, name) == known.end()) fault(name, "unknown here");
    }
  }

  void text(const char* name, std::string& value) {
    const auto found = object_.find(name);
    if (found == object_.end()) return;
    const auto* given = found->get_ptr<const std::string*>();
    if (given == nullptr || given->size() > kMaxTextBytes || !is_plain_text(*given)) {
      return fault(name, fmt::format("one line of text of at most {} bytes", kMaxTextBytes));
    }
    value = *given;
  }

  void whole(const char* name, int low, int high, int& value) {
    const auto found = object_.find(name);
    if (found == object_.end()) return;
    const bool is_whole = found->is_number_integer();
    if (!is_whole || *found < low || *found > high) {
      return fault(name, fmt::format("a whole number from {} to {}", low, high));
    }
    value = found->get<int>();
  }

  // double or std::optional<double>
  void real(const char* name, double low, double high, auto& value) {
    const auto found = object_.find(name);
    if (found == object_.end() || found->is_null()) return;
    if (!found->is_number() || !(*found >= low && *found <= high)) {
      return fault(name, fmt::format("a number from {} to {}", low, high));
    }
    value = found->get<double>();
  }

  void flag(const char* name, bool& value) {
    const auto found = object_.find(name);
    if (found == object_.end()) return;
    if (!found->is_boolean()) return fault(name, "true or false");
    value = found->get<bool>();
  }

  template <class Enum>
  void choice(const char* name, std::span<const std::string_view> names, Enum& value) {
    const auto found = object_.find(name);
    if (found == object_.end()) return;
    const auto* given = found->get_ptr<const std::string*>();
    const auto at = given == nullptr ? names.end() : std::ranges::find(names, *given);
    if (at == names.end()) return fault(name, "one of " + joined(names));
    value = static_cast<Enum>(at - names.begin());
  }

  void fault(const std::string& name, std::string expected) {
    faults_.push_back({prefix_ + name, std::move(expected)});
  }

 private:
  const Json& object_;
  const std::string prefix_;
  FieldFaults& faults_;
};

// 0 and "auto": by the mesh.
void read_bits(Fields& fields, const Json& body, int& bits) {
  const auto found = body.find("bits");
  if (found == body.end() || *found == "auto") return;
  if (found->is_number_integer() && *found == 0) {
    bits = 0;
    return;
  }
  const bool fits = found->is_number_integer() && *found >= kMinBits && *found <= kMaxBits;
  if (!fits) {
    return fields.fault("bits",
                        fmt::format("auto or a whole number from {} to {}", kMinBits, kMaxBits));
  }
  bits = found->get<int>();
}

void read_length(Fields& fields, const Json& body, int& length) {
  const auto found = body.find("length");
  if (found == body.end()) return;
  const bool fits =
      found->is_number_integer() &&
      std::ranges::find(kSamplingLengths, found->get<std::int64_t>()) != kSamplingLengths.end();
  if (!fits)
    return fields.fault("length", fmt::format("one of {}", fmt::join(kSamplingLengths, ", ")));
  length = found->get<int>();
}

void read_metadata(Fields& fields, const Json& body, ModelMetadata& metadata, FieldFaults& faults) {
  constexpr std::string_view kKnown[] = {"title", "creator", "rights", "licence"};
  const auto found = body.find("metadata");
  if (found == body.end()) return;
  if (!found->is_object()) return fields.fault("metadata", "an object");
  Fields texts(*found, "metadata.", faults);
  texts.only(kKnown);
  texts.text("title", metadata.title);
  texts.text("creator", metadata.creator);
  texts.text("rights", metadata.rights);
  texts.text("licence", metadata.licence);
}

void read_processing(Fields& fields, const Json& body, Processing& processing) {
  auto& [stripe, sampling, surface] = processing;
  fields.choice("stripe", kStripeNames, stripe.method);
  fields.choice("sampling", kSamplingNames, sampling.method);
  read_length(fields, body, sampling.window);
  fields.real("largest_angle", 0, kMostAngle, surface.largest_angle);
  fields.real("largest_hole", 0, kMostHole, surface.largest_hole);
}

void read_model(Fields& fields, const Json& body, ScanOrder& order, FieldFaults& faults) {
  fields.whole("calibration", 1, kMostCalibration, order.calibration);
  read_processing(fields, body, order.request.processing);
  read_bits(fields, body, order.bits);
  fields.choice("placement", kPlacements, order.placement);
  read_metadata(fields, body, order.metadata, faults);
  fields.flag("publish", order.publish);
}

void read_scan(Fields& fields, const Json& body, ScanOrder& order) {
  fields.text("scanner", order.scanner);
  if (!body.contains("scanner")) fields.fault("scanner", "the name of one of /api/v1/scanners");
  fields.whole("steps", kLeastSteps, kMostSteps, order.request.steps);
  fields.real("exposure", kLeastExposure, kMostExposure, order.request.exposure_us);
  fields.flag("keep_frames", order.request.keep_frames);
}

// What may be said, by whom.
constexpr std::string_view kOfScan[] = {"scanner", "steps", "exposure", "keep_frames"};
constexpr std::string_view kOfModel[] = {"calibration",   "stripe",       "sampling", "length",
                                         "largest_angle", "largest_hole", "bits",     "placement",
                                         "metadata",      "publish"};

std::vector<std::string_view> names(std::initializer_list<std::span<const std::string_view>> sets) {
  std::vector<std::string_view> all;
  for (const auto set : sets)
    all.insert(all.end(), set.begin(), set.end());
  return all;
}

template <class Order>
tl::expected<Order, FieldFaults> result(Order order, FieldFaults faults) {
  if (!faults.empty()) return tl::unexpected(std::move(faults));
  return order;
}

}  // namespace

tl::expected<ScanOrder, FieldFaults> parse_scan_order(const Json& body) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ScanOrder order;
  fields.only(names({kOfScan, kOfModel}));
  read_scan(fields, body, order);
  read_model(fields, body, order, faults);
  return result(std::move(order), std::move(faults));
}

tl::expected<ScanOrder, FieldFaults> parse_reprocess_order(const Json& body,
                                                           const ScanOrder& scan) {
  FieldFaults faults;
  Fields fields(body, "", faults);
  ScanOrder order = scan;
  fields.only(names({kOfModel}));
  read_model(fields, body, order, faults);
  return result(std::move(order), std::move(faults));
}

tl::expected<CalibrationOrder, FieldFaults> parse_calibration_order(const Json& body) {
  constexpr std::string_view kKnown[] = {"poses"};
  FieldFaults faults;
  Fields fields(body, "", faults);
  CalibrationOrder order;
  fields.only(kKnown);
  fields.whole("poses", kLeastPoses, kMostPoses, order.poses);
  return result(order, std::move(faults));
}

std::string to_json_text(const CalibrationOrder& order) {
  return Json{{"poses", order.poses}}.dump();
}

tl::expected<ScanOrder, FieldFaults> parse_kept_order(const Json& kept) {
  FieldFaults faults;
  Fields fields(kept, "", faults);
  ScanOrder order;
  fields.only(names({kOfScan, kOfModel}));
  read_scan(fields, kept, order);
  read_model(fields, kept, order, faults);
  return result(std::move(order), std::move(faults));
}

std::string to_json_text(const ScanOrder& order) {
  const ModelMetadata& texts = order.metadata;
  const auto& [stripe, sampling, surface] = order.request.processing;
  Json json = {{"scanner", order.scanner},
               {"steps", order.request.steps},
               {"keep_frames", order.request.keep_frames},
               {"stripe", kStripeNames[static_cast<std::size_t>(stripe.method)]},
               {"sampling", kSamplingNames[static_cast<std::size_t>(sampling.method)]},
               {"length", sampling.window},
               {"largest_angle", surface.largest_angle},
               {"largest_hole", surface.largest_hole},
               {"bits", order.bits},
               {"placement", kPlacements[static_cast<std::size_t>(order.placement)]},
               {"metadata",
                {{"title", texts.title},
                 {"creator", texts.creator},
                 {"rights", texts.rights},
                 {"licence", texts.licence}}},
               {"publish", order.publish}};
  if (order.request.exposure_us) json["exposure"] = *order.request.exposure_us;
  if (order.calibration > 0) json["calibration"] = order.calibration;
  return json.dump();
}

}  // namespace vitrine
