// SPDX-License-Identifier: Apache-2.0
// Splits vertices that belong to several fans of faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The first fan of each vertex keeps the vertex; every other fan gets a copy of it. Two faces at a
// vertex are in the same fan if one can be reached from the other through paired edges
// (edge_pairs.h) at that vertex. Rewrites `faces`. Returns the original vertex of each copy. Copies
// are numbered from `vertex_count` on. Uses OpenMesh's half-edge kernel, but only for faces around
// vertices with several fans.
std::vector<std::uint32_t> split_fans(std::uint32_t vertex_count, std::span<Triangle> faces,
                                      std::span<const std::uint32_t> across);

}  // namespace vitrine::inline codec
