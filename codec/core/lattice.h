// SPDX-License-Identifier: Apache-2.0
// The cubic integer grid on which all coding is exact (DESIGN section 2, "Lattice").
#pragma once

#include <span>

#include "codec/core/vec.h"

namespace vitrine {

// Model position = origin + step * lattice coordinate. Coordinates run over [0, 2^bits - 1].
struct Lattice {
  Vec3 origin;      // minimum corner of the bounding box, model units
  double step = 1;  // model units per lattice unit, > 0 and finite
  int bits = 12;    // kMinBits..kMaxBits

  constexpr bool operator==(const Lattice&) const = default;
  Vec3 to_model(const Vec3i& p) const { return origin + to_vec3(p) * step; }
  Vec3i to_lattice(const Vec3& p) const;  // rounds half up, clamps to the grid
};

// The grid of `bits` bits over the bounding box of finite `positions`: step = longest side /
// (2^bits - 1), or 1 where the box is a point.
Lattice fit_lattice(std::span<const Vec3> positions, int bits);

}  // namespace vitrine
