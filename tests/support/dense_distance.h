// SPDX-License-Identifier: Apache-2.0
// The largest distance of a fine grid of points on triangles: what a bound must not be below.
#pragma once

#include <algorithm>
#include <cmath>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine::test {

inline double dense_maximum(const Corners& t, const TriangleBvh& to) {
  constexpr int kGrid = 10;
  double most = 0;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; i + j <= kGrid; ++j) {
      const Vec3 p = t.a + (t.b - t.a) * (1.0 * i / kGrid) + (t.c - t.a) * (1.0 * j / kGrid);
      most = std::max(most, to.closest(p).squared);
    }
  }
  return std::sqrt(most);
}

inline double dense_maximum(const TriangleMesh& from, const TriangleBvh& to) {
  double most = 0;
  for (const Triangle& f : from.faces) {
    const Corners t{from.positions[f[0]], from.positions[f[1]], from.positions[f[2]]};
    most = std::max(most, dense_maximum(t, to));
  }
  return most;
}

}  // namespace vitrine::test
