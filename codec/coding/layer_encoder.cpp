// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/layer_encoder.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

// Sorts components by the positions of their first vertices, so that each component is near the
// previous one. This saves bits.
void sort_components(std::vector<const Component*>& insertions) {
  const auto begin = [](const Component* c) {
    const std::uint32_t v = ComponentReplay::first_vertex(*c);
    return std::pair(c->mesh.positions[v], c->ids[v]);
  };
  std::ranges::sort(insertions, std::less<>(), begin);
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
    chunks.push_back({.node = node, .insertions = {}, .bytes = {}});
  }
  for (std::uint32_t k = 0; k < collapses.size(); ++k) {
    collapse_of_[collapses[k].v1] = k;
    ++chunks[chunk_of[hierarchy_->leaf[collapses[k].v1]]].splits;
  }
  for (const Component& component : hierarchy_->insertions[level_ - 1]) {
    EncodedChunk& chunk = chunks[chunk_of[hierarchy_->leaf[component.ids[0]]]];
    chunk.insertions.push_back(&component);
    chunk.inserted += static_cast<std::uint32_t>(component.ids.size());
  }
  for (EncodedChunk& chunk : chunks)
    sort_components(chunk.insertions);
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
    while (chunk.splits + chunk.inserted > most_new_vertices(chunk.bytes.size()))
      chunk.bytes.push_back(0);
  }
  end_level();
  return chunks;
}

}  // namespace vitrine::inline codec
