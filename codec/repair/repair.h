// SPDX-License-Identifier: Apache-2.0
// Turns any set of triangles into a manifold with boundary. Removes only degenerate and duplicate
// faces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::inline codec {

struct RepairedMesh {
  TriangleMesh mesh;  // satisfies Connectivity::close()
  // The repairs made during import, then one line for each kind of repair made here.
  std::vector<std::string> repairs;
  std::uint64_t boundary_edges = 0;
  std::uint64_t components = 0;  // number of components; faces that share a vertex are connected
  Texturing texturing;           // texturing of `mesh`
};

// Repairs a mesh in these steps:
// - Faces that repeat a vertex are removed.
// - Duplicates of an earlier face (same vertices in the same cyclic order) are removed.
// - Each connected patch gets the orientation of the majority of its faces.
// - At an edge with three or more faces, the faces are paired by angle. This separates solids that
//   touch at the edge. Two opposed faces on the same vertices become two separate sheets.
// - One-sided surfaces are cut.
// - Vertices with several fans are split into one vertex per fan.
// - Unused vertices are removed.
//
// All other faces stay, in their order. Materials and texture coordinates stay with their
// corners. Fails (kBadInput) if an index is out of range or no face has an area. Takes O(n log n)
// time.
Expected<RepairedMesh> repair(ImportedMesh imported);

}  // namespace vitrine::inline codec
