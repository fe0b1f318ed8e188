// SPDX-License-Identifier: Apache-2.0
// Whether single precision can hold a mesh.
#pragma once

#include "codec/core/bounds.h"

namespace vitrine {

// True where single precision would move vertices by more than about a millionth of the longest
// side: coordinates of a map do that to an object.
bool is_far_from_origin(const Bounds& bounds);

// By how much single precision moves a coordinate at most.
double most_rounding(const Bounds& bounds);

}  // namespace vitrine
