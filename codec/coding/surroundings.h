// SPDX-License-Identifier: Apache-2.0
// Computes the inputs of the models from the mesh around a vertex. The inputs do not depend on the
// order in which regions are refined (see layer_pass.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/cut_model.h"
#include "codec/coding/displacement_model.h"
#include "codec/coding/flag_model.h"
#include "codec/coding/mesh_state.h"

namespace vitrine::inline codec {

// The data needed to undo a vertex split.
struct Split {
  VertexId v = 0;
  Vec3i merged;  // position v~ before the split
};

// The splits of one chunk, in coded order.
struct ChunkSplits {
  VertexId first_vertex = 0;  // the new vertex of the first split
  std::uint32_t first_face = 0;
  std::vector<Split> splits;
  // The attributes of v before the splits: for each attribute of the mesh, one value per split.
  std::array<std::vector<Vec3i>, kSemantics> merged_attributes;

  std::size_t size() const { return splits.size(); }
  VertexId v(std::size_t s) const { return splits[s].v; }
  // Returns the new vertex of split s.
  VertexId w(std::size_t s) const { return first_vertex + static_cast<VertexId>(s); }
  // Returns the first new face of split s, (v, q_i, w). The second new face, (v, w, q_j), is the
  // next one.
  std::uint32_t face(std::size_t s) const { return first_face + 2 * static_cast<std::uint32_t>(s); }
};

struct OneRing {
  std::uint32_t size = 0;
  std::array<Corner, kMaxSplitValence> corners;
  std::array<VertexId, kMaxSplitValence> vertices;
};

// Fills `ring` with the one-ring of v, counter-clockwise from the neighbour with the smallest
// MeshState::canonical(). Returns false if the valence exceeds kMaxSplitValence.
bool gather_ring(const MeshState& mesh, VertexId v, OneRing& ring);

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const OneRing& ring,
                           std::uint32_t level);

RingGeometry ring_geometry(const MeshState& mesh, VertexId v, const OneRing& ring);

// Returns the surroundings of split s = errors.size(), in the mesh after pass 1 (layer_pass.h). The
// vertices of all splits before s have their final positions; `errors` holds the prediction errors
// of these splits.
SplitSurroundings split_surroundings(const MeshState& mesh, const ChunkSplits& chunk,
                                     std::span<const SplitError> errors);

// Predicts the difference in an attribute between the two vertices of the s-th split. `column` is
// the index of the attribute in MeshState::attributes.
Vec3 predicted_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s,
                          std::size_t column);

}  // namespace vitrine::inline codec
