// SPDX-License-Identifier: Apache-2.0
// Makes any set of triangles a set of manifolds with boundary, without losing a face.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/import/read_mesh.h"

namespace vitrine {

struct RepairedMesh {
  TriangleMesh mesh;                 // Connectivity::close accepts it
  std::vector<std::string> repairs;  // those of the import, then one line for each kind made here
  std::uint64_t boundary_edges = 0;
  std::uint64_t components = 0;  // connected by shared vertices
};

// In this order: faces that repeat a vertex are dropped; of exact duplicates (the same vertices in
// the same cyclic order) the first is kept; each connected patch gets one orientation, that of its
// majority; at an edge of three or more faces the faces are paired by angle, so that touching
// solids part and opposed faces on the same vertices become two sheets; where a surface has only
// one side it is cut; vertices are split, one for each fan; unreferenced vertices are dropped.
// All other faces are kept, in order. Fails (kBadInput) when an index is out of range or no face
// has an area. O(n log n).
Expected<RepairedMesh> repair(ImportedMesh imported);

}  // namespace vitrine
