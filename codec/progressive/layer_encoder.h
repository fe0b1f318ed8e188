// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/birth_replay.h"
#include "codec/progressive/hierarchy.h"
#include "codec/progressive/mesh_state.h"
#include "codec/progressive/region_fork.h"
#include "codec/progressive/replay.h"

namespace vitrine {

struct EncodedChunk {
  std::uint32_t node = 0;  // of the tree: the region
  std::uint32_t splits = 0, newborn = 0;
  std::vector<const Component*> births;  // of the hierarchy, in coded order
  std::vector<std::uint8_t> bytes;
};

// Replays a hierarchy from the base up, level by level, and codes each chunk.
class LayerEncoder {
 public:
  // `base` is the base mesh in the order in which its own buffer decodes; `fine_ids[v]` is the
  // hierarchy's id of base vertex v.
  static Expected<LayerEncoder> start(const Hierarchy& hierarchy, const BaseMesh& base,
                                      std::vector<VertexId> fine_ids);

  // Codes the next level, 1 first.
  Expected<std::vector<EncodedChunk>> encode_level();

  // The parts of encode_level(), for a coder other than the RangeEncoder: begin_level() once, then
  // code_chunk() for each chunk it gives, then end_level(). `observe` sees the pass after the
  // chunk.
  std::vector<EncodedChunk> begin_level();
  template <class Coder, class Observer>
  Expected<void> code_chunk(Coder& coder, const EncodedChunk& chunk, const Observer& observe);
  void end_level();

  std::uint32_t level() const { return level_; }  // 0: the base
  const MeshState& mesh() const { return mesh_; }

 private:
  LayerEncoder(const Hierarchy& hierarchy, MeshState mesh)
      : hierarchy_(&hierarchy), mesh_(std::move(mesh)) {}

  template <class Coder>
  Expected<void> code_births(Coder& coder, const ChunkFrame& frame, const EncodedChunk& chunk);

  const Hierarchy* hierarchy_;
  MeshState mesh_;
  std::vector<VertexId> fine_;              // fine id of each vertex of the state
  std::vector<VertexId> state_;             // and back; kNoCorner where not born yet
  std::vector<std::uint32_t> collapse_of_;  // per fine id: its collapse in the level being coded
  std::vector<Vec3i> cell_;                 // per fine id, where the level refines the lattice
  std::uint32_t level_ = 0;
};

template <class Coder, class Observer>
Expected<void> LayerEncoder::code_chunk(Coder& coder, const EncodedChunk& chunk,
                                        const Observer& observe) {
  const ChunkFrame frame{
      .level = level_,
      .region = static_cast<std::uint16_t>(hierarchy_->tree.nodes[chunk.node].first),
      .splits = chunk.splits,
      .newborn = chunk.newborn,
      .shift = hierarchy_->shift[level_],
      .shift_before = hierarchy_->shift[level_ - 1],
      .placement = hierarchy_->placement,
      .parity = level_parity(level_, static_cast<std::uint32_t>(hierarchy_->levels.size()))};
  Replay replay(hierarchy_->levels[level_ - 1], collapse_of_, fine_, state_, cell_);
  const auto pass = std::make_unique<LayerPass<Coder, Replay>>(mesh_, frame, coder, replay);
  if (auto ok = pass->run(); !ok) return tl::unexpected(ok.error());
  observe(*pass);
  if (auto ok = code_births(coder, frame, chunk); !ok) return ok;
  if (!hierarchy_->tree.nodes[chunk.node].forks_by(level_ + 1)) return {};
  const auto leaf = [&](VertexId v) { return hierarchy_->leaf[fine_[v]]; };
  code_fork(mesh_, coder, hierarchy_->tree, chunk.node, level_ + 1, leaf);
  return {};
}

template <class Coder>
Expected<void> LayerEncoder::code_births(Coder& coder, const ChunkFrame& frame,
                                         const EncodedChunk& chunk) {
  if (chunk.births.empty()) return {};
  BirthReplay replay(chunk.births, fine_, state_);
  const auto pass = std::make_unique<BirthPass<Coder, BirthReplay>>(mesh_, frame, coder, replay);
  if (auto ok = pass->run(); !ok) return tl::unexpected(ok.error());
  return {};
}

}  // namespace vitrine
