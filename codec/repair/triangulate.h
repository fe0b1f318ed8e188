// SPDX-License-Identifier: Apache-2.0
// Cuts polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/corner_tree.h"

namespace vitrine::inline codec {

// Largest number of corners of a polygon that becomes a triangle fan. In a larger fan, too many
// long triangles would meet at one vertex.
inline constexpr std::size_t kMostFanCorners = 256;

// Appends the n - 2 triangles of a polygon. The polygon is given as n >= 3 indices into
// `positions`, counter-clockwise. The corners of the triangles are indices into `polygon`. A convex
// polygon with at most kMostFanCorners corners becomes a triangle fan, and so does a polygon with
// unusable positions (raw_mesh.h). All other polygons are cut by ear clipping, in about n log n
// time.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles);

// Cuts a flat polygon by ear clipping. An ear is a convex corner whose triangle with its two
// neighbours contains no other corner.
//
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
