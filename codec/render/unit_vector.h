// SPDX-License-Identifier: Apache-2.0
// Vectors of length 1.
#pragma once

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Returns the direction of `v`, or +z if its length is 0.
inline Vec3 unit_vector(const Vec3& v) {
  const double l = length(v);
  return l > 0 ? v * (1 / l) : Vec3{0, 0, 1};
}

}  // namespace vitrine::inline codec
