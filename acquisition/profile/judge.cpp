// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

namespace vitrine::acquisition {
namespace {

constexpr double kLeastRows = 2;  // least average number of rows with a stripe in a frame
constexpr double kMostSaturated = .8, kMostDoubled = .5;
// Largest accepted share of pixels at the end of the camera's range. A normal stripe, or a lamp in
// view, covers only a hundredth of a picture.
constexpr double kMostFull = .05;
constexpr int kFullLevel = 254;     // grey level at which a stripe counts as saturated
constexpr double kLeastHeight = 1;  // least height of an object, in mm
constexpr double kStrays = .02;     // share of the highest, and of the lowest, points ignored
constexpr double kMostShift = 10;   // largest shift of a line between adjacent rows, in pixels

// Returns whether two points in adjacent rows belong to a line. Noise often exceeds the threshold
// in one row, but rarely at nearly the same place in the next row too.
bool is_line(const StripePoint& a, const StripePoint& b) {
  return b.row == a.row + 1 && std::abs(b.u - a.u) <= kMostShift;
}

// Returns the first point of each row. Flags the point kDouble if the row has a second point, even
// a weak one.
std::vector<StripePoint> one_a_row(std::span<const StripePoint> stripe) {
  std::vector<StripePoint> first;
  for (const StripePoint& point : stripe) {
    if (!(point.flags & kSecond))
      first.push_back(point);
    else if (!first.empty() && first.back().row == point.row)
      first.back().flags |= kDouble;
  }
  return first;
}

// Returns the range of the heights, in mm, without the share kStrays at each end.
double extent(std::vector<double>& heights) {
  std::ranges::sort(heights);
  const auto strays = static_cast<std::size_t>(kStrays * static_cast<double>(heights.size()));
  return heights[heights.size() - 1 - strays] - heights[strays];
}

}  // namespace

StripeCount count(std::span<const StripePoint> stripe) {
  const std::vector<StripePoint> first = one_a_row(stripe);
  StripeCount sum{.frames = 1};
  for (std::size_t i = 0; i < first.size(); ++i) {
    const StripePoint& point = first[i];
    const bool continues = (i > 0 && is_line(first[i - 1], point)) ||
                           (i + 1 < first.size() && is_line(point, first[i + 1]));
    if (!continues) continue;
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
  return {.frames = a.frames + b.frames,
          .rows = a.rows + b.rows,
          .saturated = a.saturated + b.saturated,
          .doubled = a.doubled + b.doubled,
          .pixels = a.pixels + b.pixels,
          .full = a.full + b.full};
}

StripeCount sum(std::span<const StripeCount> counts) {
  return std::accumulate(counts.begin(), counts.end(), StripeCount{}, std::plus<>());
}

RowShares shares(const StripeCount& scan, int height) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  const std::uint64_t all = scan.frames * static_cast<std::uint64_t>(height);
  return {share(all - std::min(all, scan.rows), all), share(scan.saturated, scan.rows),
          share(scan.doubled, scan.rows)};
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
                            "the table, check that the laser is on, and raise the exposure",
                            scan.rows, scan.frames));
  if (static_cast<double>(scan.saturated) > kMostSaturated * rows)
    return fail(ErrorCode::kBadInput,
                fmt::format("all saturated: {} of {} rows are at the end of the camera's range; "
                            "lower the exposure or the gain",
                            scan.saturated, scan.rows));
  if (static_cast<double>(scan.doubled) > kMostDoubled * rows)
    return fail(ErrorCode::kBadInput,
                fmt::format("two stripes: {} of {} rows show the laser twice; cover reflecting "
                            "surfaces, and switch the other laser off",
                            scan.doubled, scan.rows));
  return {};
}

Expected<void> judge(std::span<const Profile> scan) {
  std::vector<double> heights;
  for (const Profile& profile : scan) {
    for (const ProfilePoint& point : profile.points)
      heights.push_back(point.at.z);
  }
  if (heights.empty())
    return fail(ErrorCode::kBadInput,
                "no stripe: no point lies in the calibrated region; put the object on the middle "
                "of the table, or calibrate a larger region");
  const double height = extent(heights);
  if (height < kLeastHeight)
    return fail(ErrorCode::kBadInput,
                fmt::format("empty turntable: {} points lie within {:.2f} mm of height; put an "
                            "object on it",
                            heights.size(), height));
  return {};
}

}  // namespace vitrine::acquisition
