// SPDX-License-Identifier: Apache-2.0
// Computes the position of the vertex that an edge collapse creates. The collapse is a lifting step
// [Sweldens98]: one difference vector suffices to undo it (codec/FORMAT.md section 5). The collapse
// computes v~ = floor((V1 + V2 + r) / 2). Encoder and decoder both know r. V1 + V2 and D = V1 - V2
// have equal parity, so V1 + V2 = 2 v~ - r + ((D + r) mod 2).
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Returns the parity term of the splits that lead to `level`. The term alternates between 0 and 1
// from level to level. Without it, rounding would shift v~ by 1/4 unit per level on average. Counts
// levels from `last_level`, the finest level, because the encoder starts there.
constexpr std::int32_t level_parity(std::uint32_t level, std::uint32_t last_level) {
  return static_cast<std::int32_t>((last_level - level) & 1);
}

// Returns the term r of midpoint placement. `parity` is level_parity().
constexpr Vec3i midpoint_term(std::int32_t parity) {
  return {parity, parity, parity};
}

// Returns the term r of pyramid placement ([WLL] eq. 8, or eq. 11 for a boundary edge, which has
// only one opposite vertex). r = 2 (sum(opposite) / 4m - sum(others) / 4n), rounded half up, plus
// `parity`. `opposite` holds the m vertices opposite to the edge. `others` holds the n other
// neighbours. With m = 2 and n = 4 the weights are those of [DLG90]. Virtual vertices are left out.
// Returns midpoint_term(parity) if m or n is 0.
Vec3i pyramid_term(std::span<const Vec3i> opposite, std::span<const Vec3i> others,
                   std::int32_t parity);

constexpr Vec3i merge(const Vec3i& v1, const Vec3i& v2, const Vec3i& r) {
  return {(v1.x + v2.x + r.x) >> 1, (v1.y + v2.y + r.y) >> 1, (v1.z + v2.z + r.z) >> 1};
}

struct SplitPair {
  Vec3i v1, v2;
};
// Undoes merge(): returns the two vertices whose merged position is `merged`. `d` is v1 - v2.
constexpr SplitPair unmerge(const Vec3i& merged, const Vec3i& d, const Vec3i& r) {
  const Vec3i sum = {2 * merged.x - r.x + ((d.x + r.x) & 1), 2 * merged.y - r.y + ((d.y + r.y) & 1),
                     2 * merged.z - r.z + ((d.z + r.z) & 1)};
  const Vec3i v1 = {(sum.x + d.x) >> 1, (sum.y + d.y) >> 1, (sum.z + d.z) >> 1};
  return {v1, v1 - d};
}

}  // namespace vitrine::inline codec
