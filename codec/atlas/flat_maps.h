// SPDX-License-Identifier: Apache-2.0
// Maps a chart to the plane. Each map returns the position of each wedge; the chart must have a
// boundary.
#pragma once

#include "codec/atlas/chart.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// Computes the least squares conformal map ([LPRM02] section 2). Two boundary wedges that are far
// apart are pinned: their distance in the plane equals their distance in space. Faces may be
// flipped.
std::vector<Vec2> conformal_map(const Chart& chart);

// Computes Tutte's embedding ([Tutte63], and [Floater97] with equal weights). The longest boundary
// loop maps to a circle. Every other wedge maps to the mean of its neighbours. Faces of a disc are
// never flipped, apart from rounding errors. Holes of the chart are treated as filled. The chart
// must have no handle.
std::vector<Vec2> tutte_embedding(const Chart& chart);

// Returns the point of the unit circle for `turn`. The point moves counter-clockwise from (1, 0)
// once around the circle while `turn` grows from 0 to 1. Each quarter uses a rational
// parametrisation, so the speed varies by a factor of two. Uses no trigonometric functions, so that
// every machine computes the same bits.
inline Vec2 on_circle(double turn) {
  const double quarters = turn * 4;
  const int whole = static_cast<int>(quarters);
  const double t = quarters - whole, scale = 1 / (1 + t * t);
  const Vec2 p{(1 - t * t) * scale, 2 * t * scale};
  switch (whole) {
    case 0:
      return p;
    case 1:
      return {-p.y, p.x};
    case 2:
      return {-p.x, -p.y};
    default:
      return {p.y, -p.x};
  }
}

}  // namespace vitrine::inline codec
