// SPDX-License-Identifier: Apache-2.0
// The box around a mesh, and whether single precision can hold what is in it.
#pragma once

#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

struct Bounds {
  Vec3 low, high;

  Vec3 centre() const { return (low + high) * 0.5; }
};

// `positions` must not be empty.
Bounds bounds_of(const std::vector<Vec3>& positions);

// Whether single precision would move vertices by more than about a millionth of the longest side:
// coordinates of a map do that to an object.
bool is_far_from_origin(const Bounds& bounds);

}  // namespace vitrine
