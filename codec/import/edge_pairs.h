// SPDX-License-Identifier: Apache-2.0
// Which faces continue each other across an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/import/edge_groups.h"

namespace vitrine {

inline constexpr std::uint32_t kNoPartner = 0xFFFF'FFFFu;

// For each corner the corner across its opposite edge, or kNoPartner. Partners run along the edge
// in opposite directions and never have the same apex. At an edge of more than two faces each face
// is paired with the one that bounds the same wedge of solid, so touching solids part.
std::vector<std::uint32_t> pair_faces(std::span<const Vec3> positions,
                                      std::span<const Triangle> faces, const EdgeGroups& groups);

}  // namespace vitrine
