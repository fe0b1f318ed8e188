// SPDX-License-Identifier: Apache-2.0
// Splits vertices that belong to several fans of faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Gives every fan of a vertex except the first one a copy of the vertex. Two faces at a vertex are
// in the same fan if one can be reached from the other through paired edges at that vertex
// (edge_pairs.h). Rewrites `faces`. Returns the original vertex of each copy; copies are numbered
// from `vertex_count` on. Uses OpenMesh's half-edge kernel for the faces around vertices with
// several fans only.
std::vector<std::uint32_t> split_fans(std::uint32_t vertex_count, std::span<Triangle> faces,
                                      std::span<const std::uint32_t> across);

}  // namespace vitrine::inline codec
