// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/layer_decoder.h"

#include <memory>
#include <utility>

#include "codec/progressive/birth_decoder.h"
#include "codec/progressive/region_fork.h"

namespace vitrine {

namespace {

// On the heap: the models are larger than a WebAssembly stack likes. And gone when it returns.
Expected<ChunkSplits> decode_splits(MeshState& mesh, const ChunkFrame& frame, RangeDecoder& coder) {
  NoTruth truth;
  return std::make_unique<LayerPass<RangeDecoder, NoTruth>>(mesh, frame, coder, truth)->run();
}

}  // namespace

Expected<LayerChange> decode_layer(MeshState& mesh, const ChunkFrame& frame, const RegionTree& tree,
                                   std::uint32_t node, std::span<const std::uint8_t> bytes) {
  RangeDecoder coder(bytes);
  auto splits = decode_splits(mesh, frame, coder);
  if (!splits) return tl::unexpected(std::move(splits.error()));
  auto components = decode_births(mesh, frame, coder);
  if (!components) return tl::unexpected(std::move(components.error()));
  if (tree.nodes[node].forks_by(frame.level + 1)) {
    const auto none = [](VertexId) { return std::uint16_t{0}; };
    code_fork(mesh, coder, tree, node, frame.level + 1, none);
  }
  return LayerChange{std::move(*splits), std::move(*components)};
}

}  // namespace vitrine
