// SPDX-License-Identifier: Apache-2.0
// Finds the neighbouring triangle across each edge of a mesh. Unlike Connectivity, this works if
// the mesh is not a manifold.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Half-edge 3 f + k runs from corner k to the next corner of face f. The result across[f][k] is the
// opposite half-edge, or the half-edge itself if it has no opposite. Only half-edges of opposite
// directions are paired. If an edge has more than two faces, half-edges are paired in the order of
// the faces. There must be fewer than 2^32 / 3 faces.
std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> faces,
                                                          std::size_t vertex_count);

}  // namespace vitrine::inline codec
