// SPDX-License-Identifier: Apache-2.0
// The output of the simplifier and input of the layer encoder: a fine mesh, and the edge collapses
// that lead from the fine mesh to the base mesh, level by level.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/format/base_mesh.h"
#include "codec/format/manifest.h"
#include "codec/mesh/connectivity.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// The collapse of the edge (v1, v2) to the vertex v~, which keeps the id of v1. Ids are vertex
// indices of the fine mesh.
struct Collapse {
  VertexId v1, v2;
  VertexId apex12;        // third vertex of the face with edge v1 -> v2; may be virtual
  VertexId apex21;        // third vertex of the face with edge v2 -> v1; may be virtual
  Vec3i p1, p2;           // positions before the collapse, in cells of the finer level
  AttributeTuple a1, a2;  // attributes before the collapse; zero for unused entries
};

// The collapses that lead from one level to the next coarser level, in the order in which they are
// performed: ascending lexicographic order of the merged positions.
using CollapseLevel = std::vector<Collapse>;

// A vertex of a level, and its cell in the next level, which has a finer lattice.
struct Refined {
  VertexId vertex;
  Vec3i cell;
};

// A small component that a level inserts as a whole.
struct Component {
  BaseMesh mesh;              // positions are cells of the level that inserts the mesh
  std::vector<VertexId> ids;  // per vertex: its id in the fine mesh
};

struct Hierarchy {
  Placement placement = Placement::kMidpoint;
  LatticeMesh base;  // without virtual faces; positions are cells of level 0; no attributes
  LatticeAttributes base_attributes;  // attributes of the base vertices
  std::vector<VertexId> base_ids;     // per base vertex: its id in the fine mesh
  std::uint32_t loops = 0;            // number of boundary loops of the fine mesh
  std::vector<CollapseLevel> levels;  // levels[0] holds the collapses from level 1 to the base
  // insertions[l] holds the components that are added when level l is refined to level l + 1.
  std::vector<std::vector<Component>> insertions;
  std::vector<std::uint32_t> shift;  // lattice shift of each level (cell.h), base first
  // refined[l] holds all vertices of level l. Empty if level l + 1 has the same lattice.
  std::vector<std::vector<Refined>> refined;
  RegionTree tree;
  std::vector<std::uint16_t> leaf;                    // per fine-mesh vertex: its leaf in `tree`
  std::vector<std::vector<std::uint32_t>> adjacency;  // per leaf: adjacent leaves, ascending
};

}  // namespace vitrine::inline codec
