// SPDX-License-Identifier: Apache-2.0
// Coarse levels stand on a coarser lattice: a vertex of a level with shift s is known up to a cell
// of 2^s lattice units a side. The mesh at hand keeps the middle of the cell, in lattice units.
#pragma once

#include <cstdint>

#include "codec/core/vec.h"

namespace vitrine {

inline constexpr std::uint32_t kMaxShift = 8;

constexpr Vec3i cell_of(const Vec3i& p, std::uint32_t shift) {
  return {p.x >> shift, p.y >> shift, p.z >> shift};
}

// Rounded up: half a unit beyond the true middle where shift > 0.
constexpr Vec3i middle_of(const Vec3i& cell, std::uint32_t shift) {
  const std::int32_t half = (1 << shift) >> 1;
  return {(cell.x << shift) + half, (cell.y << shift) + half, (cell.z << shift) + half};
}

// From what is kept to the true middle of the cell: what is displayed, and what errors are of.
constexpr double display_offset(std::uint32_t shift) {
  return shift > 0 ? -0.5 : 0;
}

}  // namespace vitrine
