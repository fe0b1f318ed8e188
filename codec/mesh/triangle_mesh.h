// SPDX-License-Identifier: Apache-2.0
// Indexed triangle meshes, in model units or on the lattice. All modules use these types.
#pragma once

#include <string>
#include <vector>

#include "codec/core/lattice.h"
#include "codec/core/vec.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// A mesh in model units. The corners of a face are counter-clockwise as seen from outside.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  VertexAttributes attributes;
};

// A mesh whose positions are lattice points. Quantisation does not change the connectivity. Several
// vertices may therefore have the same position, and faces may have no area.
struct LatticeMesh {
  Lattice lattice;
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  VertexAttributes attributes;
};

// Rounds the positions of `mesh` to points of `lattice`. Copies faces and attributes.
LatticeMesh quantise(const TriangleMesh& mesh, const Lattice& lattice);

TriangleMesh to_model(const LatticeMesh& mesh);

}  // namespace vitrine::inline codec
