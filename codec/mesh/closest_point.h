// SPDX-License-Identifier: Apache-2.0
// The distance from a point to one triangle.
#pragma once

#include <array>

#include "codec/core/vec.h"

namespace vitrine {

struct Corners {
  Vec3 a, b, c;
};

// The point of the triangle that is closest to `p`. Triangles without area are handled as what
// they are: segments or points.
Vec3 closest_point(const Corners& triangle, const Vec3& p) noexcept;

inline double squared_distance(const Corners& triangle, const Vec3& p) noexcept {
  const Vec3 d = p - closest_point(triangle, p);
  return dot(d, d);
}

}  // namespace vitrine
