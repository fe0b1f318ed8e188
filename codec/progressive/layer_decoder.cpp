// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/layer_decoder.h"

#include <memory>

#include "codec/progressive/region_fork.h"

namespace vitrine {

Expected<std::vector<Split>> decode_layer(MeshState& mesh, const ChunkFrame& frame,
                                          std::span<const RegionPlane> planes,
                                          std::span<const std::uint8_t> bytes) noexcept {
  RangeDecoder coder(bytes);
  NoTruth truth;
  // On the heap: the models are larger than a WebAssembly stack likes.
  const auto pass = std::make_unique<LayerPass<RangeDecoder, NoTruth>>(mesh, frame, coder, truth);
  auto splits = pass->run();
  if (!splits || planes.empty()) return splits;
  const auto none = [](VertexId) { return std::uint16_t{0}; };
  if (auto ok = code_fork(mesh, coder, planes, none); !ok) return tl::unexpected(ok.error());
  return splits;
}

}  // namespace vitrine
