// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace vitrine {
namespace {

constexpr double kLeastRows = 2;  // a frame, on the average
constexpr double kMostSaturated = .8, kMostDoubled = .5;
constexpr double kMostFull = .05;   // a stripe is a hundredth of a picture, a lamp in view no more
constexpr int kFullLevel = 254;     // grey levels, as where a stripe is saturated
constexpr double kLeastHeight = 1;  // mm

}  // namespace

StripeCount count(std::span<const StripePoint> stripe) {
  StripeCount sum{.frames = 1};
  for (const StripePoint& point : stripe) {
    if (point.flags & kSecond) continue;
    ++sum.rows;
    if (point.flags & kSaturated) ++sum.saturated;
    if (point.flags & kDouble) ++sum.doubled;
  }
  return sum;
}

StripeCount count_full(const Frame& picture) {
  const auto full =
      std::ranges::count_if(picture.pixels, [](int level) { return level >= kFullLevel; });
  return {.pixels = picture.pixels.size(), .full = static_cast<std::uint64_t>(full)};
}

StripeCount operator+(const StripeCount& a, const StripeCount& b) {
  return {a.frames + b.frames,   a.rows + b.rows,     a.saturated + b.saturated,
          a.doubled + b.doubled, a.pixels + b.pixels, a.full + b.full};
}

bool shows_stripe(const StripeCount& scan) {
  return static_cast<double>(scan.rows) > kLeastRows * static_cast<double>(scan.frames);
}

Expected<void> judge(const StripeCount& scan) {
  const auto rows = static_cast<double>(scan.rows), pixels = static_cast<double>(scan.pixels);
  const auto full = static_cast<double>(scan.full);
  if (full > kMostFull * pixels)
    return fail(ErrorCode::kBadInput,
                fmt::format("over-exposed: {:.0f} % of all pixels are at the end of the camera's "
                            "range; lower the exposure or the gain, or darken the room",
                            100 * full / pixels));
  if (!shows_stripe(scan))
    return fail(ErrorCode::kBadInput,
                fmt::format("no stripe: {} rows of {} pictures show the laser; put an object on "
                            "the table, check that the laser is on, raise the exposure",
                            scan.rows, scan.frames));
  if (static_cast<double>(scan.saturated) > kMostSaturated * rows)
    return fail(ErrorCode::kBadInput,
                fmt::format("all saturated: {} of {} rows are at the end of the camera's range; "
                            "lower the exposure or the gain",
                            scan.saturated, scan.rows));
  if (static_cast<double>(scan.doubled) > kMostDoubled * rows)
    return fail(ErrorCode::kBadInput,
                fmt::format("two stripes: {} of {} rows show a second peak as strong; cover what "
                            "reflects the laser, switch the other laser off",
                            scan.doubled, scan.rows));
  return {};
}

Expected<void> judge(std::span<const Profile> scan) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t points = 0;
  for (const Profile& profile : scan) {
    points += profile.points.size();
    for (const ProfilePoint& point : profile.points)
      low = std::min(low, point.at.z), high = std::max(high, point.at.z);
  }
  if (points == 0)
    return fail(ErrorCode::kBadInput,
                "no stripe: no point lies in the calibrated region; put the object on the middle "
                "of the table, or calibrate a larger region");
  if (high - low < kLeastHeight)
    return fail(ErrorCode::kBadInput,
                fmt::format("empty turntable: all {} points lie within {:.2f} mm of height; put an "
                            "object on it",
                            points, high - low));
  return {};
}

}  // namespace vitrine
