// SPDX-License-Identifier: Apache-2.0
// Where an edge collapse puts its vertex, so that one difference vector undoes it (DESIGN section
// 2, "Edge collapse as a lifting step"): v~ = floor((V1 + V2 + r) / 2) with r known to both sides;
// V1 + V2 and D = V1 - V2 have equal parity, so V1 + V2 = 2 v~ - r + ((D + r) mod 2).
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/vec.h"

namespace vitrine {

// The parity term of the splits that lead to `level`, counted from the finest level `last_level`
// because that is where the encoder starts. Without it v~ sinks by 1/4 unit a level.
constexpr std::int32_t level_parity(std::uint32_t level, std::uint32_t last_level) {
  return static_cast<std::int32_t>((last_level - level) & 1);
}

// r of the midpoint placement; `parity` is level_parity().
constexpr Vec3i midpoint_term(std::int32_t parity) {
  return {parity, parity, parity};
}

// r of the pyramid placement, the paper's eq. 8 (eq. 11 at a boundary edge, where `opposite` has
// one entry): 2 (sum(opposite) / 4m - sum(others) / 4n), rounded half up, plus the level's parity.
// `opposite` are the m real vertices opposite the edge, `others` the n other real neighbours.
Vec3i pyramid_term(std::span<const Vec3i> opposite, std::span<const Vec3i> others,
                   std::int32_t parity);

constexpr Vec3i merge(const Vec3i& v1, const Vec3i& v2, const Vec3i& r) {
  return {(v1.x + v2.x + r.x) >> 1, (v1.y + v2.y + r.y) >> 1, (v1.z + v2.z + r.z) >> 1};
}

struct SplitPair {
  Vec3i v1, v2;
};
// The two vertices that `merge` made v~ of; d = v1 - v2.
constexpr SplitPair unmerge(const Vec3i& merged, const Vec3i& d, const Vec3i& r) {
  const Vec3i sum = {2 * merged.x - r.x + ((d.x + r.x) & 1), 2 * merged.y - r.y + ((d.y + r.y) & 1),
                     2 * merged.z - r.z + ((d.z + r.z) & 1)};
  const Vec3i v1 = {(sum.x + d.x) >> 1, (sum.y + d.y) >> 1, (sum.z + d.z) >> 1};
  return {v1, v1 - d};
}

}  // namespace vitrine
