// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe.h"

#include <fmt/format.h>

#include <algorithm>

#include "acquisition/profile/peaks.h"
#include "acquisition/profile/steady_rows.h"
#include "acquisition/profile/stripe_path.h"
#include "acquisition/profile/sub_pixel.h"

namespace vitrine {
namespace {

constexpr int kFull = 254;  // grey levels: from here the camera's range is used up
constexpr int kFullPixels = 2;
constexpr double kAsStrong = .5;  // of the chosen peak: another that could be meant as well

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

}  // namespace

Expected<std::vector<StripePoint>> find_stripe(const Frame& lit, const Frame& dark,
                                               const StripeOptions& options) {
  if (lit.width != dark.width || lit.height != dark.height)
    return fail(ErrorCode::kBadInput,
                fmt::format("the pictures with and without laser have {}x{} and {}x{} pixels: set "
                            "one region of interest for both",
                            lit.width, lit.height, dark.width, dark.height));
  const std::vector<RowPeaks> rows = find_peaks(lit, dark, options);
  const std::vector<int> chosen = choose_peaks(rows);
  const SubPixel sub_pixel(options);
  std::vector<StripePoint> stripe;
  stripe.reserve(rows.size());
  for (std::size_t v = 0; v < rows.size(); ++v) {
    if (rows[v].count == 0) continue;
    const int row = static_cast<int>(v);
    const Peak& peak = rows[v].peaks[static_cast<std::size_t>(chosen[v])];
    if (const auto u = sub_pixel.centre(lit.row(row), dark.row(row), peak.u))
      stripe.push_back({row, *u, static_cast<double>(peak.strength),
                        flags_of(rows[v], chosen[v], lit.row(row))});
  }
  steady(stripe, options.steady_rows);
  return stripe;
}

}  // namespace vitrine
