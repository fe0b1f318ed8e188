// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Two faces meet at a vertex only if they are in one fan: reached from one another through paired
// edges at that vertex (edge_pairs.h). Gives every further fan of a vertex a copy of it: rewrites
// `faces` and returns the vertex that each copy came from; the copies are numbered from
// `vertex_count` on. Works on OpenMesh's half-edge kernel, which holds only the faces round
// vertices with several fans.
std::vector<std::uint32_t> split_fans(std::uint32_t vertex_count, std::span<Triangle> faces,
                                      std::span<const std::uint32_t> across);

}  // namespace vitrine
