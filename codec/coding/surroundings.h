// SPDX-License-Identifier: Apache-2.0
// Computes the inputs of the probability models from the mesh around a vertex. The inputs do not
// depend on the order in which regions are refined (see layer_pass.h).
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
  Vec3i merged;  // position of v before the split (v~)
};

// The splits of one chunk, in the order in which they are coded.
struct ChunkSplits {
  VertexId first_vertex = 0;  // the new vertex of the first split
  std::uint32_t first_face = 0;
  std::vector<Split> splits;
  // Per attribute: the value of v before each split.
  std::array<std::vector<Vec3i>, kSemantics> merged_attributes;

  std::size_t size() const { return splits.size(); }
  VertexId v(std::size_t s) const { return splits[s].v; }
  // Returns the new vertex of split s.
  VertexId w(std::size_t s) const { return first_vertex + static_cast<VertexId>(s); }
  // Returns the first of the two faces that split s adds: (v, q_i, w), where q_i and q_j are the
  // ring vertices of v at which the split begins and ends. The second face, (v, w, q_j), has the
  // next index.
  std::uint32_t face(std::size_t s) const { return first_face + 2 * static_cast<std::uint32_t>(s); }
};

struct OneRing {
  std::uint32_t size = 0;
  std::array<Corner, kMaxSplitValence> corners;
  std::array<VertexId, kMaxSplitValence> vertices;
};

// Stores the one-ring of v in `ring`, counter-clockwise from any neighbour. Returns false if the
// valence exceeds kMaxSplitValence.
bool gather_ring(const MeshState& mesh, VertexId v, OneRing& ring);

// Rotates the ring so that it starts at the neighbour with the smallest MeshState::canonical()
// number.
void start_canonically(const MeshState& mesh, OneRing& ring);

FlagFeatures flag_features(const MeshState& mesh, VertexId v, const OneRing& ring,
                           std::uint32_t level);

RingGeometry ring_geometry(const MeshState& mesh, VertexId v, const OneRing& ring);

// A split whose two vertices, v and the new vertex w, have their final positions.
struct PlacedSplit {
  Vec3 d;            // final position of v minus final position of w, in lattice units
  SplitError error;  // error of the prediction of `d`
};

// Returns the surroundings of the next split, whose index is placed.size(), in the mesh after pass
// 1 (layer_pass.h). `placed` holds all earlier splits.
SplitSurroundings split_surroundings(const MeshState& mesh, const ChunkSplits& chunk,
                                     std::span<const PlacedSplit> placed);

// Predicts the difference in an attribute between the two vertices of split s. `column` is the
// index of the attribute in MeshState::attributes.
Vec3 predicted_difference(const MeshState& mesh, const ChunkSplits& chunk, std::size_t s,
                          std::size_t column);

}  // namespace vitrine::inline codec
