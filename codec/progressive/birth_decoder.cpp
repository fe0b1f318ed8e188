// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/birth_decoder.h"

#include <memory>

#include "codec/progressive/birth_pass.h"

namespace vitrine {

Expected<std::vector<Newborn>> decode_births(MeshState& mesh, const ChunkFrame& frame,
                                             RangeDecoder& coder) {
  if (frame.newborn == 0) return std::vector<Newborn>();
  NoBirthTruth truth;
  // On the heap: the models are larger than a WebAssembly stack likes.
  return std::make_unique<BirthPass<RangeDecoder, NoBirthTruth>>(mesh, frame, coder, truth)->run();
}

}  // namespace vitrine
