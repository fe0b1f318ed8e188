// SPDX-License-Identifier: Apache-2.0
// Returns the largest distance to a mesh from a fine grid of points on triangles. A correct error
// bound is at least this distance.
#pragma once

#include <algorithm>
#include <cmath>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine::test {

inline double dense_maximum(const TrianglePoints& t, const TriangleBvh& to) {
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
    const TrianglePoints t{from.positions[f[0]], from.positions[f[1]], from.positions[f[2]]};
    most = std::max(most, dense_maximum(t, to));
  }
  return most;
}

}  // namespace vitrine::test
