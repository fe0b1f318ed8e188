// SPDX-License-Identifier: Apache-2.0
// The paper's own loop (section 3.3): the cheapest pair of all collapses, one at a time, from a
// heap. The reference that collapses in batches (matching.h) are compared with.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/progressive/hierarchy.h"
#include "codec/simplify/matching.h"

namespace vitrine {

// Collapses until `target_vertices` are left or no pair is legal. The record is grouped into levels
// by dependency: a collapse goes to the first level from the fine end in which nothing that it
// meets has changed and nothing that it changes is met, so levels are independent sets, each in
// ascending order of its v~, no two the same. Levels from fine to coarse, at most `most_levels`.
// `rules` says placement and bounds; parity and regions follow from the grouping.
std::vector<CollapseLevel> collapse_by_heap(Surface& surface, const LevelRules& rules,
                                            std::uint32_t target_vertices,
                                            std::uint32_t most_levels);

}  // namespace vitrine
