// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <span>

#include "acquisition/device/board.h"
#include "acquisition/session/json_members.h"
#include "acquisition/session/region_json.h"

namespace vitrine::acquisition {
namespace {

using nlohmann::json;

// The longest possible capture, with all its repeated requests, must end before the watchdog acts.
static_assert(std::chrono::duration<double, std::micro>(longest_capture(kMostExposure)) <
              kWatchdog);

template <class Method>
std::string_view name_in(std::span<const std::string_view> names, Method method) {
  return names[static_cast<std::size_t>(method)];
}

json to_json(const Processing& processing) {
  const auto& [stripe, sampling, surface] = processing;
  return {{"stripe",
           {{"method", name_in(kStripeNames, stripe.method)},
            {"width", stripe.width},
            {"contrast", stripe.contrast},
            {"steady_rows", stripe.steady_rows}}},
          {"sampling",
           {{"method", name_in(kSamplingNames, sampling.method)}, {"length", sampling.window}}},
          {"surface",
           {{"largest_spacing", surface.largest_spacing},
            {"largest_angle", surface.largest_angle},
            {"largest_hole", surface.largest_hole},
            {"smallest_piece", surface.smallest_piece}}}};
}

StripeOptions stripe_in(JsonMembers& root) {
  StripeOptions stripe;
  auto members = root.object("stripe", {"method", "width", "contrast", "steady_rows"});
  stripe.method = static_cast<StripeMethod>(members.choice("method", kStripeNames, 0));
  stripe.width = members.number("width", 0.5, 50, stripe.width);
  stripe.contrast = members.number("contrast", 0, 1'000, stripe.contrast);
  stripe.steady_rows = members.whole("steady_rows", 0, 1'000, stripe.steady_rows);
  root.adopt(members);
  return stripe;
}

SamplingOptions sampling_in(JsonMembers& root) {
  SamplingOptions sampling;
  auto members = root.object("sampling", {"method", "length"});
  sampling.method = static_cast<SamplingMethod>(
      members.choice("method", kSamplingNames, static_cast<std::size_t>(sampling.method)));
  sampling.window = members.whole("length", 1, 1'000, sampling.window);
  root.adopt(members);
  return sampling;
}

SurfaceOptions surface_in(JsonMembers& root) {
  SurfaceOptions surface;
  auto members = root.object(
      "surface", {"largest_spacing", "largest_angle", "largest_hole", "smallest_piece"});
  surface.largest_spacing = members.number("largest_spacing", 0, 1'000, surface.largest_spacing);
  surface.largest_angle = members.number("largest_angle", 0, kMostAngle, surface.largest_angle);
  surface.largest_hole = members.number("largest_hole", 0, kMostHole, surface.largest_hole);
  surface.smallest_piece = static_cast<std::size_t>(
      members.whole("smallest_piece", 0, 1'000'000'000, static_cast<int>(surface.smallest_piece)));
  root.adopt(members);
  return surface;
}

}  // namespace

Expected<void> check(const ScanRequest& request) {
  if (request.steps < kLeastSteps || request.steps > kMostSteps) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} steps are too few or too many; choose {} to {}", request.steps,
                            kLeastSteps, kMostSteps));
  }
  if (request.exposure_us && !(*request.exposure_us > 0 && *request.exposure_us <= kMostExposure)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("an exposure of {} us is too short or too long; choose up to {}",
                            *request.exposure_us, kMostExposure));
  }
  if (std::ranges::find(kSamplingLengths, request.processing.sampling.window) !=
      kSamplingLengths.end())
    return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("a sampling length of {} points is not supported; choose 5, 10, 15 or 20",
                          request.processing.sampling.window));
}

std::string to_json_text(const ScanRecord& record) {
  json object = to_json(record.request.processing);
  object["created"] = record.created;
  object["scanner"] = record.scanner;
  object["steps"] = record.request.steps;
  object["keep_frames"] = record.request.keeps_frames;
  object["camera"] = record.camera;
  object["exposure_us"] = record.settings.exposure_us;
  object["gain_db"] = record.settings.gain_db;
  object["region"] = to_json(record.settings.region);
  object["board"] = record.board;
  object["calibration"] = record.calibration;
  object["calibration_digest"] = record.calibration_digest;
  return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

Expected<ScanRecord> scan_record_of(std::string_view text, const std::string& place) {
  const auto object = parse_json_object(text, place);
  if (!object) return tl::unexpected(object.error());
  JsonMembers members(
      *object, place,
      {"created", "scanner", "steps", "keep_frames", "camera", "exposure_us", "gain_db", "region",
       "board", "calibration", "calibration_digest", "stripe", "sampling", "surface"});
  ScanRecord record;
  record.request.steps = members.whole("steps", kLeastSteps, kMostSteps, 0);
  record.request.keeps_frames = members.flag("keep_frames", false);
  record.request.processing = {.stripe = stripe_in(members),
                               .sampling = sampling_in(members),
                               .surface = surface_in(members)};
  record.created = members.text("created");
  record.scanner = members.text("scanner");
  record.camera = members.text("camera");
  record.settings.exposure_us = members.number("exposure_us", 0, kMostExposure, 0);
  record.settings.gain_db = members.number("gain_db", -100, 100, 0);
  record.settings.region = region_in(members);
  record.board = members.text("board");
  record.calibration = members.whole("calibration", 0, kMostCalibration, 0);
  record.calibration_digest = members.text("calibration_digest");
  record.request.exposure_us = record.settings.exposure_us;
  if (!members.has("steps")) members.fault("steps", "is missing");
  if (auto checked = members.check(); !checked) return tl::unexpected(checked.error());
  return record;
}

}  // namespace vitrine::acquisition
