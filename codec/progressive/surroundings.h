// SPDX-License-Identifier: Apache-2.0
// What the models see of the mesh around a vertex. Everything here is independent of the order in
// which regions are refined (layer_pass.h says why).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/progressive/cut_model.h"
#include "codec/progressive/displacement_model.h"
#include "codec/progressive/flag_model.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// A vertex split as it was applied: what it takes to undo it.
struct Split {
  VertexId v = 0;
  Vec3i merged;  // v~
};

// The splits of one chunk, in coded order.
struct ChunkSplits {
  VertexId first_vertex = 0;  // what the first split brought
  std::uint32_t first_face = 0;
  std::vector<Split> splits;
  std::vector<Vec3i> merged_colours;  // YCoCg-R, or empty

  std::size_t size() const { return splits.size(); }
  VertexId v(std::size_t s) const { return splits[s].v; }
  VertexId w(std::size_t s) const {
    return first_vertex + static_cast<VertexId>(s);
  }  // the new one
  // The face (v, q_i, w); the next one is (v, w, q_j).
  std::uint32_t face(std::size_t s) const { return first_face + 2 * static_cast<std::uint32_t>(s); }
};

struct Ring {
  std::uint32_t size = 0;
  std::array<Corner, kMaxSplitValence> corners;
  std::array<VertexId, kMaxSplitValence> vertices;
};

// The one-ring of v from its canonically smallest vertex on; false above kMaxSplitValence.
bool gather_ring(const MeshState& mesh, VertexId v, Ring& ring);

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const Ring& ring,
                           std::uint32_t level);

CutRing cut_ring(const MeshState& mesh, VertexId v, const Ring& ring);

// Surroundings of the s-th split in the fine connectivity. `errors` holds those of the predicted D
// of the s splits before, which have their final positions.
SplitSurroundings split_surroundings(const MeshState& mesh, const ChunkSplits& chunk,
                                     std::span<const SplitError> errors);

// Difference of the mean colours around the two vertices of the s-th split.
Vec3 colour_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s);

}  // namespace vitrine
