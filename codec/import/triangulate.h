// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

inline constexpr std::size_t kMostClippedCorners = 256;  // clipping is quadratic

// Appends the n - 2 triangles of a polygon (n >= 3 indices into `positions`, counter-clockwise):
// a fan where it is convex, ear clipping where it is not; above kMostClippedCorners always a fan.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles);

}  // namespace vitrine
