// SPDX-License-Identifier: Apache-2.0
// Which triangle lies across each edge, for any triangle soup (Connectivity asks for a manifold).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// across[f][k] is the face on the other side of the edge from corner k to corner k + 1 of face f,
// f itself where there is none. Only faces that run along the edge in opposite directions are
// paired, as found where there are more than two.
std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> faces,
                                                          std::size_t vertex_count);

}  // namespace vitrine
