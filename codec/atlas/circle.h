// SPDX-License-Identifier: Apache-2.0
// Computes points of the unit circle without trigonometric functions, so that every machine
// computes the same bits.
#pragma once

#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// Returns the point of the unit circle for `turn`. The point moves counter-clockwise from (1, 0)
// once around the circle while `turn` grows from 0 to 1. Each quarter uses a rational
// parametrisation, so the speed varies by a factor of two.
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
