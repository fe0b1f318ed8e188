// SPDX-License-Identifier: Apache-2.0
// Cuts a flat polygon into triangles by ear clipping. An ear is a convex corner whose triangle with
// its two neighbours contains no other corner.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/corner_tree.h"

namespace vitrine::inline codec {

// Appends the n - 2 triangles of a polygon with n >= 3 corners, counter-clockwise. Their corners
// are indices into `polygon`. Returns the number of steps: the tests of corners, and the nodes of
// the CornerTree that they visit.
//
// Clips ears in passes. A pass skips the neighbours of the ears that it has clipped. A convex
// polygon therefore loses half of its corners in each pass, and no vertex gets many triangles.
//
// Takes about n log n steps, and at most about 64 n log n steps. After that many steps, each convex
// corner counts as an ear. If a polygon that intersects itself runs out of ears, any corner is
// clipped.
std::uint64_t clip_ears(std::span<const FlatCorner> polygon, std::vector<Triangle>& triangles);

}  // namespace vitrine::inline codec
