// SPDX-License-Identifier: Apache-2.0
// Runs the npm package of meshoptimizer. This version can respect attributes and move vertices to
// better positions; Debian's version of the library cannot.
#pragma once

#include <vector>

#include "peers.h"

namespace vitrine::bench {

struct SimplifiedArrays {
  MeshoptInput mesh;
  double seconds = 0;  // processor time of the simplification alone
};

// Simplifies a mesh to about `faces` triangles, and moves vertices. Returns one mesh for each
// number of faces. Keeps the seams of attributes, unless the mesh would then have too many faces.
// Needs Node.
std::vector<SimplifiedArrays> simplify_in_node(const MeshoptInput& mesh,
                                               const std::vector<std::size_t>& faces);

}  // namespace vitrine::bench
