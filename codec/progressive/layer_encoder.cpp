// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/layer_encoder.h"

namespace vitrine {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

VertexId virtual_neighbour(const Connectivity& mesh, VertexId v) {
  Corner c = mesh.corner_at(v);
  while (!is_virtual(mesh.vertex(next(c))))
    c = mesh.swing(c);
  return mesh.vertex(next(c));
}

}  // namespace

Expected<LayerEncoder> LayerEncoder::start(const Hierarchy& hierarchy, const BaseMesh& base,
                                           std::vector<VertexId> fine_ids) {
  auto mesh = MeshState::from_base(base, hierarchy.shift[0], hierarchy.tree.leaves());
  if (!mesh) return tl::unexpected(mesh.error());
  LayerEncoder encoder(hierarchy, std::move(*mesh));
  encoder.fine_ = std::move(fine_ids);
  encoder.fine_.reserve(hierarchy.leaf.size());
  encoder.state_.assign(hierarchy.leaf.size(), kNone);
  encoder.collapse_of_.assign(hierarchy.leaf.size(), kNone);
  for (VertexId v = 0; v < encoder.fine_.size(); ++v)
    encoder.state_[encoder.fine_[v]] = v;
  for (const std::uint32_t member : hierarchy.loop_member) {
    const VertexId v = encoder.state_[hierarchy.base_ids[member]];
    encoder.loop_.push_back(virtual_neighbour(encoder.mesh_.connectivity, v));
  }
  return encoder;
}

std::vector<EncodedChunk> LayerEncoder::begin_level() {
  const CollapseLevel& collapses = hierarchy_->levels[level_++];
  std::vector<EncodedChunk> chunks;
  std::vector<std::size_t> chunk_of(hierarchy_->tree.leaves());
  for (const std::uint32_t node : hierarchy_->tree.regions_at(level_)) {
    const RegionNode& region = hierarchy_->tree.nodes[node];
    for (std::uint32_t leaf = region.first; leaf < region.first + region.leaves; ++leaf)
      chunk_of[leaf] = chunks.size();
    chunks.push_back({.node = node, .splits = 0, .bytes = {}});
  }
  for (std::uint32_t k = 0; k < collapses.size(); ++k) {
    collapse_of_[collapses[k].v1] = k;
    ++chunks[chunk_of[hierarchy_->leaf[collapses[k].v1]]].splits;
  }
  cell_.resize(hierarchy_->refined[level_ - 1].empty() ? 0 : hierarchy_->leaf.size());
  for (const Refined& r : hierarchy_->refined[level_ - 1])
    cell_[r.vertex] = r.cell;
  return chunks;
}

void LayerEncoder::end_level() {
  for (const Collapse& c : hierarchy_->levels[level_ - 1])
    collapse_of_[c.v1] = kNone;
}

Expected<std::vector<EncodedChunk>> LayerEncoder::encode_level() {
  std::vector<EncodedChunk> chunks = begin_level();
  for (EncodedChunk& chunk : chunks) {
    RangeEncoder coder;
    if (auto ok = code_chunk(coder, chunk, [](const auto&) {}); !ok) {
      return tl::unexpected(ok.error());
    }
    chunk.bytes = coder.finish();
    while (chunk.splits > most_splits(chunk.bytes.size()))
      chunk.bytes.push_back(0);
  }
  end_level();
  return chunks;
}

}  // namespace vitrine
