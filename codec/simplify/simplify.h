// SPDX-License-Identifier: Apache-2.0
// From a fine mesh to a base mesh by levels of edge collapses, recorded so that vertex splits undo
// them exactly, and without the components that are too small for a level (DESIGN section 2,
// "Levels").
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/hierarchy.h"

namespace vitrine {

enum class CollapseOrder : std::uint8_t {
  kBatch,  // few levels, each of many collapses with disjoint ends (matching.h)
  kHeap,   // the cheapest pair of all, one at a time (heap_order.h): many levels and one region
};

struct SimplifyOptions {
  Placement placement = Placement::kMidpoint;
  CollapseOrder order = CollapseOrder::kBatch;
  std::uint32_t target_vertices = 300;  // of the base mesh, about
  // Regions of more vertices than this fork; 0: the model is one region. A region of the coarsest
  // levels may have fewer: its vertices cost more bytes there.
  std::uint32_t region_vertices = 0;
  std::function<void(double)> progress = {};  // fraction done, 0..1; called once a level
};

// `original`: where the vertices were before they were rounded to the lattice, model units, one for
// each of `fine` in its order; empty: where they are. Quadrics are of its planes, which rounding
// would tilt where edges are a few steps long.
// Fails (kBadInput) where Connectivity::close refuses the faces. The base stays larger than asked
// where no legal collapse is left (high genus; by heap, many components) or the format's number of
// levels is reached. Where the coarsest level is more than one region, the model is simplified as
// one. v~ lies within a quarter of the lattice's side of the lattice; with the midpoint placement
// within it. The same input gives the same hierarchy on every machine.
Expected<Hierarchy> simplify(const LatticeMesh& fine, const SimplifyOptions& options,
                             std::span<const Vec3> original = {});

}  // namespace vitrine
