// SPDX-License-Identifier: Apache-2.0
// Cuts polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// With more corners, ear clipping would be too slow, because it takes quadratic time.
inline constexpr std::size_t kMostClippedCorners = 256;

// Appends the n - 2 triangles of a polygon, given as n >= 3 indices into `positions` in
// counter-clockwise order. The corners of the triangles are indices into `polygon`. A convex
// polygon becomes a fan, any other one is cut by ear clipping. A polygon with more than
// kMostClippedCorners corners always becomes a fan.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles);

}  // namespace vitrine::inline codec
