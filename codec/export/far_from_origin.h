// SPDX-License-Identifier: Apache-2.0
// Decides whether single precision is precise enough for the coordinates of a mesh.
#pragma once

#include "codec/core/bounds.h"

namespace vitrine::inline codec {

// Whether single precision would move vertices by more than about a millionth of the longest side
// of their bounding box. This happens to objects in map coordinates.
bool is_far_from_origin(const Bounds& bounds);

// Returns the largest distance by which single precision moves a coordinate.
double most_rounding(const Bounds& bounds);

}  // namespace vitrine::inline codec
