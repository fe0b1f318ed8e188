// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/layer_decoder.h"

#include <memory>

#include "codec/coding/component_pass.h"

namespace vitrine::inline codec {

Expected<std::vector<InsertedComponent>> decode_components(MeshState& mesh, const ChunkFrame& frame,
                                                           RangeDecoder& coder) {
  if (frame.inserted == 0) return std::vector<InsertedComponent>();
  NoComponentTruth truth;
  // Allocates the pass on the heap, because its models do not fit on a WebAssembly stack.
  return std::make_unique<ComponentPass<RangeDecoder, NoComponentTruth>>(mesh, frame, coder, truth)
      ->run();
}

}  // namespace vitrine::inline codec
