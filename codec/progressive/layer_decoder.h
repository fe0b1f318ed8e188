// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/layer_pass.h"
#include "codec/progressive/region_tree.h"

namespace vitrine {

// What a chunk did, in coded order.
struct LayerChange {
  ChunkSplits splits;
  std::vector<Newborn> components;  // behind the splits
};

// Decodes one chunk into `mesh`. `node` is the chunk's region in `tree`; where that forks in the
// next level, the chunk says which child each vertex goes to.
// Safe on hostile bytes; after an error `mesh` is a manifold in memory, but of no use.
Expected<LayerChange> decode_layer(MeshState& mesh, const ChunkFrame& frame, const RegionTree& tree,
                                   std::uint32_t node, std::span<const std::uint8_t> bytes);

}  // namespace vitrine
