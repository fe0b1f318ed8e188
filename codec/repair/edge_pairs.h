// SPDX-License-Identifier: Apache-2.0
// Pairs the faces that are neighbours across an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/edge_groups.h"

namespace vitrine::inline codec {

inline constexpr std::uint32_t kNoPartner = 0xFFFF'FFFFu;

// Returns, for each corner, the corner across the opposite edge, or kNoPartner. Paired faces run
// along the edge in opposite directions and never have the same third vertex. At an edge with more
// than two faces, two faces are paired if they bound the same wedge of solid. This separates solids
// that touch at the edge.
std::vector<std::uint32_t> pair_faces(std::span<const Vec3> positions,
                                      std::span<const Triangle> faces, const EdgeGroups& groups);

}  // namespace vitrine::inline codec
