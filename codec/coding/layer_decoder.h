// SPDX-License-Identifier: Apache-2.0
// Decodes one chunk: the vertex splits and component insertions of one level in one region.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/layer_pass.h"
#include "codec/coding/mesh_state.h"
#include "codec/core/expected.h"
#include "codec/core/range_coder.h"
#include "codec/format/chunk_frame.h"
#include "codec/format/region_tree.h"

namespace vitrine::inline codec {

// The changes made by a chunk, in coded order.
struct LayerChange {
  ChunkSplits splits;
  std::vector<InsertedComponent> components;  // inserted after all splits
};

// Decodes one chunk and applies it to `mesh`. `node` is the index of the chunk's region in `tree`.
// If the region forks in the next level, the chunk also codes the child region of each vertex. Safe
// on hostile bytes. After an error, `mesh` can be destroyed safely but must not be used.
Expected<LayerChange> decode_layer(MeshState& mesh, const ChunkFrame& frame, const RegionTree& tree,
                                   std::uint32_t node, std::span<const std::uint8_t> bytes);

// Decodes the component insertions of a chunk, which follow its vertex splits. Inserts them
// into `mesh` and returns them in coded order. Errors are as in decode_layer().
Expected<std::vector<InsertedComponent>> decode_components(MeshState& mesh, const ChunkFrame& frame,
                                                           RangeDecoder& coder);

}  // namespace vitrine::inline codec
