// SPDX-License-Identifier: Apache-2.0
// What the models see of the mesh around a vertex. Everything here is independent of the order in
// which regions are refined (layer_pass.h says why).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/progressive/cut_model.h"
#include "codec/progressive/displacement_model.h"
#include "codec/progressive/flag_model.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// A vertex split as it was applied.
struct Split {
  VertexId v = 0, w = 0;       // w is the new vertex
  Vec3i merged;                // v~
  Vec3i merged_colour;         // YCoCg-R
  Vec3i term;                  // r of the placement
  std::uint32_t new_face = 0;  // (v, q_i, w); the next face is (v, w, q_j)
  SplitError error;            // of its predicted D
};

struct Ring {
  std::uint32_t size = 0;
  std::array<Corner, kMaxSplitValence> corners{};
  std::array<VertexId, kMaxSplitValence> vertices{};
};

// The one-ring of v from its canonically smallest vertex on; false above kMaxSplitValence.
bool gather_ring(const MeshState& mesh, VertexId v, Ring& ring);

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const Ring& ring,
                           std::uint32_t level);

CutRing cut_ring(const MeshState& mesh, VertexId v, const Ring& ring);

// Surroundings of splits[s] in the fine connectivity; splits before s have their final positions.
SplitSurroundings split_surroundings(const MeshState& mesh, std::span<const Split> splits,
                                     std::size_t s);

// Difference of the mean colours around the two vertices of a split.
Vec3 colour_difference(const MeshState& mesh, const Split& split);

}  // namespace vitrine
