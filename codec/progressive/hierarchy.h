// SPDX-License-Identifier: Apache-2.0
// What the simplifier records and the layer encoder replays: a fine mesh and the edge collapses
// that lead from it to the base mesh, level by level.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/mesh/connectivity.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/base_mesh.h"
#include "codec/progressive/manifest.h"

namespace vitrine {

// The edge (v1, v2) became v~, which keeps the identity v1. Ids are the fine mesh's own.
struct Collapse {
  VertexId v1, v2;
  VertexId apex12;  // third vertex of the face with the directed edge v1 -> v2 (may be virtual)
  VertexId apex21;  // third vertex of the face with the directed edge v2 -> v1 (may be virtual)
  Vec3i p1, p2;     // positions before the collapse: cells (cell.h) of the finer level
  Vec3i c1, c2;     // colours before the collapse, YCoCg-R; zero where the mesh has none
};

// One level: collapses in the order performed, which is ascending lexicographic order of v~.
using CollapseLevel = std::vector<Collapse>;

// Where a vertex of a level stands on the finer lattice of the next one.
struct Refined {
  VertexId vertex;
  Vec3i cell;
};

// A small component as it is when a level brings it.
struct Component {
  BaseMesh mesh;              // cells of that level
  std::vector<VertexId> ids;  // fine id of each vertex
};

struct Hierarchy {
  Placement placement = Placement::kMidpoint;
  LatticeMesh base;                   // compacted: real faces, cells of level 0, no colours
  std::vector<Vec3i> base_colours;    // YCoCg-R per base vertex; empty where there are none
  std::vector<VertexId> base_ids;     // fine id of each base vertex
  std::uint32_t loops = 0;            // boundary loops of the fine mesh
  std::vector<CollapseLevel> levels;  // [0] leads from the base to level 1 (coarse to fine)
  std::vector<std::vector<Component>> births;  // [l]: what level l + 1 has and level l has not
  std::vector<std::uint32_t> shift;            // of each level's lattice (cell.h); the base first
  // [l]: all vertices of level l; empty where level l + 1 has the same lattice.
  std::vector<std::vector<Refined>> refined;
  RegionTree tree;
  std::vector<std::uint16_t> leaf;                    // of the tree, per fine vertex
  std::vector<std::vector<std::uint32_t>> adjacency;  // per leaf: those next to it, ascending
};

}  // namespace vitrine
