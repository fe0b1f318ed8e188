// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "acquisition/profile/peaks.h"
#include "acquisition/profile/stripe_steps.h"
#include "acquisition/profile/sub_pixel.h"

namespace vitrine::acquisition {
namespace {

constexpr int kFull = 254;  // grey level from which a pixel counts as saturated
constexpr int kFullPixels = 2;
// If another peak has at least this share of the chosen peak's strength, either may be the stripe.
constexpr double kAsStrong = .5;

bool is_saturated(std::span<const std::uint8_t> lit, int u) {
  const auto from = lit.begin() + std::max(u - 1, 0);
  const auto to = lit.begin() + std::min(u + 2, static_cast<int>(lit.size()));
  return std::count_if(from, to, [](int level) { return level >= kFull; }) >= kFullPixels;
}

std::uint8_t flags_of(const RowPeaks& row, int chosen, std::span<const std::uint8_t> lit) {
  const Peak& peak = row.peaks[static_cast<std::size_t>(chosen)];
  std::uint8_t flags = is_saturated(lit, peak.u) ? kSaturated : 0;
  if (row.count == 2 &&
      row.peaks[static_cast<std::size_t>(1 - chosen)].strength >= kAsStrong * peak.strength)
    flags |= kDouble;
  return flags;
}

class Finder {
 public:
  Finder(const Frame& lit, const Frame& dark, const StripeOptions& options)
      : lit_(lit), dark_(dark), sub_pixel_(options), steady_rows_(options.steady_rows) {}

  // Refines one peak of each row to sub-pixel precision. `taken` has the index of this peak, or a
  // negative number to skip the row. Adds `flags` to each point.
  std::vector<StripePoint> line(std::span<const RowPeaks> rows, std::span<const int> taken,
                                std::uint8_t flags) const {
    std::vector<StripePoint> points;
    points.reserve(rows.size());
    for (std::size_t v = 0; v < rows.size(); ++v) {
      if (taken[v] < 0) continue;
      const int row = static_cast<int>(v);
      const Peak& peak = rows[v].peaks[static_cast<std::size_t>(taken[v])];
      if (const auto u = sub_pixel_.centre(lit_.row(row), dark_.row(row), peak.u))
        points.push_back(
            {row, *u, static_cast<double>(peak.strength),
             static_cast<std::uint8_t>(flags | flags_of(rows[v], taken[v], lit_.row(row)))});
    }
    steady(points, steady_rows_);
    return points;
  }

 private:
  const Frame &lit_, &dark_;
  const SubPixel sub_pixel_;
  const int steady_rows_;
};

}  // namespace

Expected<std::vector<StripePoint>> find_stripe(const Frame& lit, const Frame& dark,
                                               const StripeOptions& options) {
  if (lit.width != dark.width || lit.height != dark.height)
    return fail(ErrorCode::kBadInput,
                fmt::format("the pictures with and without laser have {}x{} and {}x{} pixels; set "
                            "the same region for both",
                            lit.width, lit.height, dark.width, dark.height));
  const std::vector<RowPeaks> rows = find_peaks(lit, dark, options);
  const std::vector<int> chosen = choose_peaks(rows), second = second_peaks(rows, chosen);
  const Finder finder(lit, dark, options);
  const std::vector<StripePoint> first = finder.line(rows, chosen, 0),
                                 behind = finder.line(rows, second, kSecond);
  std::vector<StripePoint> stripe;
  stripe.reserve(first.size() + behind.size());
  std::ranges::merge(first, behind, std::back_inserter(stripe), {}, &StripePoint::row,
                     &StripePoint::row);
  return stripe;
}

}  // namespace vitrine::acquisition
