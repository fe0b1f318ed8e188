// SPDX-License-Identifier: Apache-2.0
// Cuts polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

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

}  // namespace vitrine::inline codec
