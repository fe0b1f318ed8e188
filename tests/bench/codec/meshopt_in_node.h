// SPDX-License-Identifier: Apache-2.0
// Runs meshoptimizer's npm package. Unlike Debian's version of the library, the package can respect
// attributes and move vertices to better positions.
#pragma once

#include <vector>

#include "peers.h"

namespace vitrine::bench {

struct SimplifiedArrays {
  MeshoptInput mesh;
  double seconds = 0;  // processor time of the simplification alone
};

// For each number in `faces`, simplifies a mesh to about that many triangles and moves vertices to
// better positions. Keeps the seams of attributes, unless the mesh would then have too many faces.
// Needs Node.
std::vector<SimplifiedArrays> simplify_in_node(const MeshoptInput& mesh,
                                               const std::vector<std::size_t>& faces);

}  // namespace vitrine::bench
