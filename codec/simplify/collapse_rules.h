// SPDX-License-Identifier: Apache-2.0
// Decides which edges may collapse and where the merged vertex goes. Checks the link condition
// [DEGN99], and that no face turns over. The placement rule (codec/format/placement.h) gives the
// position of the merged vertex.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/format/manifest.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

// The one-ring of a vertex. corner[i] is a corner at the vertex. vertex[i] is the neighbour at the
// next corner of the same face.
struct Star {
  // Maximum valence of a vertex at the end of a collapsing edge.
  static constexpr std::uint32_t kCapacity = kMaxSplitValence + 2;
  std::uint32_t valence = 0;  // number of neighbours; 0 if there are more than kCapacity
  bool is_on_border = false;
  std::array<Corner, kCapacity> corner;
  std::array<VertexId, kCapacity> vertex;

  Star(const Connectivity& mesh, VertexId v);
  std::span<const VertexId> neighbours() const { return {vertex.data(), valence}; }
};

// An edge (v1, v2) and its surroundings. A collapse removes v2; v1 keeps its id.
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

// Whether the mesh, with its boundary loops closed by virtual faces (connectivity.h), remains a
// simplicial manifold after the collapse [DEGN99]. Checks that v1 and v2 share exactly two
// neighbours, that neither of these neighbours has valence 3, and that the collapse does not join
// two parts of the boundary. Also checks that the merged vertex has a valence of at most
// kMaxSplitValence.
bool keeps_manifold(const Connectivity& mesh, const EdgeStar& edge);

// Returns the position v~ of the merged vertex, as the rule of codec/format/placement.h defines it.
Vec3i merged_position(const Surface& surface, const EdgeStar& edge, Placement placement,
                      std::int32_t parity);

// Whether every face around the edge keeps its orientation and has an area if both ends move to
// `target`. Faces that have no area before the collapse are ignored: quantisation creates such
// faces, and collapses must be able to remove them.
bool keeps_orientation(const Surface& surface, const EdgeStar& edge, const Vec3i& target);

}  // namespace vitrine::inline codec
