// SPDX-License-Identifier: Apache-2.0
// Simplifies a fine mesh to a base mesh [Hoppe96], in levels of edge collapses. Records the
// collapses so that vertex splits can undo them exactly. A level also omits components that are too
// small to be visible in it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "codec/core/expected.h"
#include "codec/format/hierarchy.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

enum class CollapseOrder : std::uint8_t {
  kBatch,  // few levels, each with many independent collapses (matching.h)
  kHeap,   // cheapest edge first (heap_order.h): many levels, one region
};

struct SimplifyOptions {
  Placement placement = Placement::kMidpoint;
  CollapseOrder order = CollapseOrder::kBatch;
  std::uint32_t target_vertices = 300;  // approximate number of vertices of the base mesh
  // A region with more vertices than this forks. Sibling regions with at most this many vertices
  // together are joined. 0 means that the whole model is one region.
  std::uint32_t region_vertices = 0;
  // Whether coarse levels may omit small components. A textured model keeps them.
  bool omits_components = true;
  unsigned threads = 1;  // at least 1; does not change the result
  // Receives the completed fraction, 0 to 1, once per level.
  std::function<void(double)> progress = {};
};

// Builds the hierarchy of `fine`. `original` holds the positions of the same vertices before
// rounding to the lattice, in model units. If `original` is empty, the rounded positions are used.
// Quadrics are computed from the planes of `original`, because rounding tilts faces that are only a
// few lattice steps wide.
//
// Fails (kBadInput) if Connectivity::close() refuses the faces. The base mesh has more vertices
// than requested if no legal collapse is left or the maximum number of levels is reached. Legal
// collapses can run out in meshes of high genus and, with kHeap, in meshes of many components. If
// the coarsest level would have more than one region, the model is simplified as a single region.
//
// With midpoint placement, merged vertices lie inside the lattice. With pyramid placement, they lie
// at most a quarter of the lattice's side outside. The same input gives the same hierarchy on every
// machine.
Expected<Hierarchy> simplify(const LatticeMesh& fine, const SimplifyOptions& options,
                             std::span<const Vec3> original = {});

}  // namespace vitrine::inline codec
