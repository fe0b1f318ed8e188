// SPDX-License-Identifier: Apache-2.0
// Which triangle lies across each edge, for any triangle soup (Connectivity asks for a manifold).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Half-edge 3 f + k runs from corner k of face f to corner k + 1. across[f][k] is the half-edge on
// the other side of it, itself where there is none (faces < 2^32 / 3). Only faces that run along
// the edge in opposite directions are paired, as found where there are more than two.
std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> faces,
                                                          std::size_t vertex_count);

}  // namespace vitrine
