// SPDX-License-Identifier: Apache-2.0
// The integer grid to which positions are rounded before coding (codec/FORMAT.md section 1.3). The
// grid points are coded without loss.
#pragma once

#include <span>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Maps lattice coordinates to model positions: origin + step * coordinate. Coordinates are in the
// range [0, 2^bits - 1].
struct Lattice {
  Vec3 origin;      // minimum corner of the model's bounding box, model units
  double step = 1;  // model units per lattice unit, > 0 and finite
  int bits = 12;    // bits per coordinate, from kMinBits to kMaxBits

  constexpr bool operator==(const Lattice&) const = default;
  Vec3 to_model(const Vec3i& p) const { return origin + to_vec3(p) * step; }
  Vec3i to_lattice(const Vec3& p) const;  // the nearest grid point; halves round up
};

// Returns the lattice over the bounding box of `positions`, with `bits` bits per coordinate. The
// positions must be finite. The step is the longest side / (2^bits - 1), or 1 if the box is a
// single point.
Lattice fit_lattice(std::span<const Vec3> positions, int bits);

}  // namespace vitrine::inline codec
