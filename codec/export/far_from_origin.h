// SPDX-License-Identifier: Apache-2.0
// Decides whether single precision suffices for the coordinates of a mesh.
#pragma once

#include "codec/core/bounds.h"

namespace vitrine::inline codec {

// Whether single precision would move vertices by more than about a millionth of the longest side
// of `bounds`. This is typical of objects in map coordinates.
bool is_far_from_origin(const Bounds& bounds);

// Returns the largest error, in model units, when a coordinate is rounded to single precision.
double most_rounding(const Bounds& bounds);

}  // namespace vitrine::inline codec
