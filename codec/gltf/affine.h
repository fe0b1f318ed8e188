// SPDX-License-Identifier: Apache-2.0
// An affine map: p -> p.x * x + p.y * y + p.z * z + origin.
#pragma once

#include <array>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

struct Affine {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};

  Vec3 turn(const Vec3& d) const { return x * d.x + y * d.y + z * d.z; }
  Vec3 operator()(const Vec3& p) const { return turn(p) + origin; }
  bool mirrors() const { return dot(cross(x, y), z) < 0; }

  // Returns the map that applies `inner` first and then this map.
  Affine operator*(const Affine& inner) const {
    return {turn(inner.x), turn(inner.y), turn(inner.z), (*this)(inner.origin)};
  }
};

// Returns the map that scales, then rotates by the unit quaternion (x, y, z, w), then translates.
inline Affine compose(const Vec3& translation, const std::array<double, 4>& q, const Vec3& scale) {
  const auto [x, y, z, w] = q;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)} * scale.x,
          Vec3{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)} * scale.y,
          Vec3{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)} * scale.z,
          translation};
}

}  // namespace vitrine::inline codec
