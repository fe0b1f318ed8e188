// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/layer_decoder.h"

#include <memory>

#include "codec/progressive/region_fork.h"

namespace vitrine {

Expected<ChunkSplits> decode_layer(MeshState& mesh, const ChunkFrame& frame, const RegionTree& tree,
                                   std::uint32_t node,
                                   std::span<const std::uint8_t> bytes) noexcept {
  RangeDecoder coder(bytes);
  NoTruth truth;
  // On the heap: the models are larger than a WebAssembly stack likes.
  const auto pass = std::make_unique<LayerPass<RangeDecoder, NoTruth>>(mesh, frame, coder, truth);
  auto splits = pass->run();
  if (!splits || !tree.nodes[node].forks_by(frame.level + 1)) return splits;
  const auto none = [](VertexId) { return std::uint16_t{0}; };
  code_fork(mesh, coder, tree, node, frame.level + 1, none);
  return splits;
}

}  // namespace vitrine
