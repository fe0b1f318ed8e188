// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/layer_decoder.h"

#include <memory>
#include <utility>

#include "codec/coding/layer_decoder.h"
#include "codec/coding/region_fork.h"

namespace vitrine::inline codec {

namespace {

// Allocates the pass on the heap, because its models do not fit on a WebAssembly stack.
Expected<ChunkSplits> decode_splits(MeshState& mesh, const ChunkFrame& frame, RangeDecoder& coder) {
  NoTruth truth;
  return std::make_unique<LayerPass<RangeDecoder, NoTruth>>(mesh, frame, coder, truth)->run();
}

}  // namespace

Expected<LayerChange> decode_layer(MeshState& mesh, const ChunkFrame& frame, const RegionTree& tree,
                                   std::uint32_t node, std::span<const std::uint8_t> bytes) {
  RangeDecoder coder(bytes);
  auto splits = decode_splits(mesh, frame, coder);
  if (!splits) return tl::unexpected(splits.error());
  auto components = decode_components(mesh, frame, coder);
  if (!components) return tl::unexpected(components.error());
  if (tree.nodes[node].forks_by(frame.level + 1)) {
    const auto none = [](VertexId) { return std::uint16_t{0}; };
    code_fork(mesh, coder, tree, node, frame.level + 1, none);
  }
  return LayerChange{std::move(*splits), std::move(*components)};
}

}  // namespace vitrine::inline codec
