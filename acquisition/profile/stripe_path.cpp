// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

// Cost of a jump, in multiples of the row's strongest peak. A reflection costs two jumps, a real
// step of the surface only one.
constexpr double kJumpCost = 6;
// Shift in pixels from one row to the next that costs nothing, because a slanted stripe is not a
// jump.
constexpr double kFreePixels = 3;
constexpr double kPixelsOfJump = 20;  // jumps of this many pixels or more have the full cost

double weakness(const RowPeaks& row, int k) {
  return 1 - static_cast<double>(row.peaks[static_cast<std::size_t>(k)].strength) /
                 row.peaks[0].strength;
}

double jump(const Peak& a, const Peak& b, int rows) {
  const double pixels = std::abs(a.u - b.u) - kFreePixels * rows;
  return kJumpCost * std::clamp(pixels / kPixelsOfJump, 0., 1.);
}

struct Link {
  std::array<double, 2> cost{};
  std::array<int, 2> from{};
};

}  // namespace

std::vector<int> choose_peaks(std::span<const RowPeaks> rows) {
  std::vector<int> chosen(rows.size(), -1);
  std::vector<Link> links(rows.size());
  std::ptrdiff_t last = -1;
  for (std::size_t v = 0; v < rows.size(); ++v) {
    for (int k = 0; k < rows[v].count; ++k) {
      const auto kk = static_cast<std::size_t>(k);
      double least = last < 0 ? 0 : 1e300;
      for (int j = 0; last >= 0 && j < rows[static_cast<std::size_t>(last)].count; ++j) {
        const auto jj = static_cast<std::size_t>(j), l = static_cast<std::size_t>(last);
        const double cost =
            links[l].cost[jj] + jump(rows[l].peaks[jj], rows[v].peaks[kk], static_cast<int>(v - l));
        if (cost < least) least = cost, links[v].from[kk] = j;
      }
      links[v].cost[kk] = least + weakness(rows[v], k);
    }
    if (rows[v].count > 0) last = static_cast<std::ptrdiff_t>(v);
  }
  int k = -1;
  for (std::size_t v = rows.size(); v-- > 0;) {
    if (rows[v].count == 0) continue;
    if (k < 0) k = rows[v].count == 2 && links[v].cost[1] < links[v].cost[0] ? 1 : 0;
    chosen[v] = k;
    k = links[v].from[static_cast<std::size_t>(k)];
  }
  return chosen;
}

}  // namespace vitrine::acquisition
