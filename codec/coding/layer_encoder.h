// SPDX-License-Identifier: Apache-2.0
// Encodes a hierarchy of collapses into chunks, level by level.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "codec/coding/collapse_replay.h"
#include "codec/coding/component_replay.h"
#include "codec/coding/mesh_state.h"
#include "codec/coding/region_fork.h"
#include "codec/core/expected.h"
#include "codec/format/hierarchy.h"

namespace vitrine::inline codec {

struct EncodedChunk {
  std::uint32_t node = 0;  // index of the chunk's region in the region tree
  std::uint32_t splits = 0, inserted = 0;
  std::vector<const Component*> insertions;  // pointers into the hierarchy, in coded order
  std::vector<std::uint8_t> bytes;
};

// Encodes a hierarchy, level by level, starting from the base mesh.
class LayerEncoder {
 public:
  // Returns an encoder at level 0. `base` has its vertices in the order of the decoded Draco
  // buffer. fine_ids[v] is the hierarchy's id of vertex v of `base`.
  static Expected<LayerEncoder> start(const Hierarchy& hierarchy, const BaseMesh& base,
                                      std::vector<VertexId> fine_ids);

  // Encodes the next level. The first call encodes level 1.
  Expected<std::vector<EncodedChunk>> encode_level();

  // The steps of encode_level(), for use with coders other than RangeEncoder. Call begin_level()
  // once, then code_chunk() for each returned chunk, then end_level(). code_chunk() calls
  // observe(pass) with the chunk's LayerPass after coding the chunk's splits.
  std::vector<EncodedChunk> begin_level();
  template <class Coder, class Observer>
  Expected<void> code_chunk(Coder& coder, const EncodedChunk& chunk, const Observer& observe);
  void end_level();

  std::uint32_t level() const { return level_; }  // 0 for the base mesh
  const MeshState& mesh() const { return mesh_; }
  // Returns for each vertex of mesh() its id in the hierarchy.
  const std::vector<VertexId>& fine_ids() const { return fine_; }

 private:
  LayerEncoder(const Hierarchy& hierarchy, MeshState mesh)
      : hierarchy_(&hierarchy), mesh_(std::move(mesh)) {}

  template <class Coder>
  Expected<void> code_components(Coder& coder, const ChunkFrame& frame, const EncodedChunk& chunk);

  const Hierarchy* hierarchy_;
  MeshState mesh_;
  std::vector<VertexId> fine_;  // per vertex of mesh_: its id in the hierarchy
  // Per id in the hierarchy: the vertex of mesh_ with this id, or 0xFFFFFFFF if it does not exist
  // yet.
  std::vector<VertexId> state_;
  // Per id in the hierarchy: the index of the collapse that is undone if this vertex splits in the
  // level being encoded, or 0xFFFFFFFF if the vertex does not split.
  std::vector<std::uint32_t> collapse_of_;
  // Per id in the hierarchy: the vertex's cell in the level being encoded. Empty if the level has
  // the same lattice as the previous one.
  std::vector<Vec3i> cell_;
  std::uint32_t level_ = 0;
};

template <class Coder, class Observer>
Expected<void> LayerEncoder::code_chunk(Coder& coder, const EncodedChunk& chunk,
                                        const Observer& observe) {
  const ChunkFrame frame{
      .level = level_,
      .region = static_cast<std::uint16_t>(hierarchy_->tree.nodes[chunk.node].first),
      .splits = chunk.splits,
      .inserted = chunk.inserted,
      .shift = hierarchy_->shift[level_],
      .shift_before = hierarchy_->shift[level_ - 1],
      .placement = hierarchy_->placement,
      .parity = level_parity(level_, static_cast<std::uint32_t>(hierarchy_->levels.size()))};
  CollapseReplay replay(hierarchy_->levels[level_ - 1], collapse_of_, fine_, state_, cell_);
  const auto pass = std::make_unique<LayerPass<Coder, CollapseReplay>>(mesh_, frame, coder, replay);
  if (auto ok = pass->run(); !ok) return tl::unexpected(ok.error());
  observe(*pass);
  if (auto ok = code_components(coder, frame, chunk); !ok) return ok;
  if (!hierarchy_->tree.nodes[chunk.node].forks_by(level_ + 1)) return {};
  const auto leaf = [&](VertexId v) { return hierarchy_->leaf[fine_[v]]; };
  code_fork(mesh_, coder, hierarchy_->tree, chunk.node, level_ + 1, leaf);
  return {};
}

template <class Coder>
Expected<void> LayerEncoder::code_components(Coder& coder, const ChunkFrame& frame,
                                             const EncodedChunk& chunk) {
  if (chunk.insertions.empty()) return {};
  ComponentReplay replay(chunk.insertions, fine_, state_);
  const auto pass =
      std::make_unique<ComponentPass<Coder, ComponentReplay>>(mesh_, frame, coder, replay);
  if (auto ok = pass->run(); !ok) return tl::unexpected(ok.error());
  return {};
}

}  // namespace vitrine::inline codec
