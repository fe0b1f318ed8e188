// SPDX-License-Identifier: Apache-2.0
// Decides which edges may collapse and where the merged vertex goes. Checks the link condition
// [DEGN99] and that no face turns over. Applies the placement rule (codec/format/placement.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/format/manifest.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

// The one-ring of a vertex. corner[i] is a corner at the vertex, and vertex[i] is the i-th
// neighbour.
struct Star {
  // Vertices of higher valence cannot collapse.
  static constexpr std::uint32_t kCapacity = kMaxSplitValence + 2;
  std::uint32_t valence = 0;  // number of neighbours; 0 if there are more than kCapacity
  bool is_on_border = false;
  std::array<Corner, kCapacity> corner;
  std::array<VertexId, kCapacity> vertex;

  Star(const Connectivity& mesh, VertexId v);
  std::span<const VertexId> neighbours() const { return {vertex.data(), valence}; }
};

// An edge (v1, v2) and its surroundings. In a collapse, v1 keeps its id.
//
//          apex12
//         /      \           .
//       v1 -----> v2         .
//         \      /           .
//          apex21
struct EdgeStar {
  VertexId v1, v2, apex12, apex21;
  Star star1, star2;

  // `c` must be the corner of v1 in the face (v1, v2, apex12).
  EdgeStar(const Connectivity& mesh, Corner c);
};

// Whether the closed mesh is still a simplicial manifold after the collapse [DEGN99], with valences
// within kMaxSplitValence. This requires that v1 and v2 share exactly two neighbours, that neither
// of these has valence 3, and that the collapse does not join two stretches of boundary.
bool keeps_manifold(const Connectivity& mesh, const EdgeStar& edge);

// Returns the position v~ to which the edge collapses, by the rule of codec/format/placement.h.
Vec3i merged_position(const Surface& surface, const EdgeStar& edge, Placement placement,
                      std::int32_t parity);

// Whether no face around the edge turns over or loses its area if both ends move to `target`. Faces
// without area are ignored: quantisation creates them, and collapses must be able to remove them.
bool keeps_orientation(const Surface& surface, const EdgeStar& edge, const Vec3i& target);

}  // namespace vitrine::inline codec
