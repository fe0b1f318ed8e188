// SPDX-License-Identifier: Apache-2.0
// Collapses one edge at a time, always the cheapest one in a heap ([WLL] section 3.3). Benchmarks
// compare collapses in batches (matching.h) with this order.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/format/hierarchy.h"
#include "codec/simplify/matching.h"

namespace vitrine::inline codec {

// Collapses edges until `target_vertices` vertices are left or no edge is legal. Groups the
// collapses into levels of independent collapses. Two collapses depend on each other if one changes
// a vertex in a one-ring of the other. Each collapse goes to the finest possible level. This level
// must be coarser than the levels of all earlier collapses on which the collapse depends, and must
// contain no collapse to the same position.
//
// Returns at most `most_levels` levels, from fine to coarse. Each level is in ascending order of
// the merged positions v~, without duplicates. Uses only the placement and the bounding box of
// `rules`. The parity follows from the number of the level. The whole mesh is one region.
std::vector<CollapseLevel> collapse_by_heap(Surface& surface, const LevelRules& rules,
                                            std::uint32_t target_vertices,
                                            std::uint32_t most_levels);

}  // namespace vitrine::inline codec
