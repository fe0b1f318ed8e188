// SPDX-License-Identifier: Apache-2.0
// Collapses one edge at a time, always the cheapest one in a heap: the loop of [WLL] section 3.3.
// Serves as the reference for collapses in batches (matching.h).
#pragma once

#include <cstdint>
#include <vector>

#include "codec/format/hierarchy.h"
#include "codec/simplify/matching.h"

namespace vitrine::inline codec {

// Collapses edges until `target_vertices` vertices are left or no edge is legal. Groups the
// collapses into levels of independent collapses. A collapse depends on an earlier one if either of
// them changes a vertex in a one-ring of the other. Each collapse goes to the finest level that is
// coarser than all collapses on which it depends and that does not contain its v~ yet.
//
// Returns at most `most_levels` levels from fine to coarse, each in ascending order of v~ without
// duplicates. Uses only the placement and the bounds of `rules`. The parity follows from the number
// of the level, and there is only one region.
std::vector<CollapseLevel> collapse_by_heap(Surface& surface, const LevelRules& rules,
                                            std::uint32_t target_vertices,
                                            std::uint32_t most_levels);

}  // namespace vitrine::inline codec
