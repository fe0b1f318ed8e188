// SPDX-License-Identifier: Apache-2.0
// Rasterises triangles of the plane conservatively, on a grid of cells with sides of 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/core/exact_math.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// Calls row(y, first_x, last_x) for each row of cells that the triangle touches, borders included.
// In row y, the triangle touches the cells first_x to last_x. Coordinates must be within the range
// of 32-bit integers.
template <class Row>
void rasterise(const std::array<Vec2, 3>& t, const Row& row) {
  const std::int32_t first = exact::floor(std::min({t[0].y, t[1].y, t[2].y}));
  const std::int32_t last = exact::floor(std::max({t[0].y, t[1].y, t[2].y}));
  for (std::int32_t y = first; y <= last; ++y) {
    double low = 1e300, high = -1e300;
    const auto reach = [&](double x) { low = std::min(low, x), high = std::max(high, x); };
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &a = t[k], &b = t[(k + 1) % 3];
      if (a.y >= y && a.y <= y + 1) reach(a.x);
      for (const double border : {y + 0.0, y + 1.0}) {
        if ((a.y < border) != (b.y < border))
          reach(a.x + (b.x - a.x) * ((border - a.y) / (b.y - a.y)));
      }
    }
    if (low <= high) row(y, exact::floor(low), exact::floor(high));
  }
}

}  // namespace vitrine::inline codec
