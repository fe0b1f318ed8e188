// SPDX-License-Identifier: Apache-2.0
// Runs the npm package of meshoptimizer. It can do more than Debian's version of the library: it
// respects attributes, and moves vertices to better positions.
#pragma once

#include <vector>

#include "peers.h"

namespace vitrine::bench {

struct SimplifiedArrays {
  MeshoptInput mesh;
  double seconds = 0;  // processor time of the simplification alone
};

// Simplifies a mesh to about `faces` triangles, and moves vertices. Returns one mesh for each
// number of faces. Seams of the attributes stay, unless a mesh with them would be too large. Needs
// Node.
std::vector<SimplifiedArrays> simplify_in_node(const MeshoptInput& mesh,
                                               const std::vector<std::size_t>& faces);

}  // namespace vitrine::bench
