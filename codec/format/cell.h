// SPDX-License-Identifier: Apache-2.0
// Conversions between lattice positions and the cells of coarse levels. In a level with shift s, a
// cell has sides of 2^s lattice units. A vertex is stored as the middle of its cell, in lattice
// units. Coarse levels thus store fewer bits, as in [VCP09].
#pragma once

#include <cstdint>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

inline constexpr std::uint32_t kMaxShift = 8;

constexpr Vec3i cell_of(const Vec3i& p, std::uint32_t shift) {
  return {p.x >> shift, p.y >> shift, p.z >> shift};
}

// Returns the middle of the cell, rounded up. If shift > 0, the result is half a unit above the
// true middle on each axis.
constexpr Vec3i middle_of(const Vec3i& cell, std::uint32_t shift) {
  const std::int32_t half = (1 << shift) >> 1;
  return {(cell.x << shift) + half, (cell.y << shift) + half, (cell.z << shift) + half};
}

// Returns the offset from the stored middle of a cell to its true middle; it is the same on each
// axis. Vertices are displayed at the true middle, and errors are computed for it.
constexpr double display_offset(std::uint32_t shift) {
  return shift > 0 ? -0.5 : 0;
}

}  // namespace vitrine::inline codec
