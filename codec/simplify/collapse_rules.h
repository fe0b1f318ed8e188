// SPDX-License-Identifier: Apache-2.0
// Which edges may collapse, and where to (DESIGN section 2, "Levels").
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/progressive/manifest.h"
#include "codec/simplify/surface.h"

namespace vitrine {

// The one-ring of a vertex: corner[i] is at it, vertex[i] is its i-th neighbour.
struct Star {
  static constexpr std::uint32_t kCapacity = kMaxSplitValence + 2;  // more cannot collapse anyway
  std::uint32_t valence = 0;                                        // 0 where it exceeds kCapacity
  bool on_border = false;
  std::array<Corner, kCapacity> corner;
  std::array<VertexId, kCapacity> vertex;

  Star(const Connectivity& mesh, VertexId v);
  std::span<const VertexId> neighbours() const { return {vertex.data(), valence}; }
};

// The edge (v1, v2) and its surroundings; v1 keeps its identity in a collapse.
//
//           apex12
//          /      \           .
//        v1 -----> v2         .
//          \      /           .
//           apex21
struct EdgeStar {
  VertexId v1, v2, apex12, apex21;
  Star star1, star2;

  // `c` is the corner of v1 in the face (v1, v2, apex12).
  EdgeStar(const Connectivity& mesh, Corner c);
};

// True if the collapse keeps the closed mesh a simplicial manifold and its valences within
// kMaxSplitValence: exactly two common neighbours, none of them of valence 3, and no joining of
// two stretches of boundary.
bool keeps_manifold(const Connectivity& mesh, const EdgeStar& edge);

// v~ of the edge by the rule of codec/progressive/placement.h.
Vec3i merged_position(const Surface& surface, const EdgeStar& edge, Placement placement,
                      std::int32_t parity);

// True if no face around the edge turns over or loses its area when both ends move to `target`.
// Faces without area are exempt: quantisation makes them, and they must be able to go.
bool keeps_orientation(const Surface& surface, const EdgeStar& edge, const Vec3i& target);

}  // namespace vitrine
