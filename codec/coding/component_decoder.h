// SPDX-License-Identifier: Apache-2.0
// Decodes the component insertions of a chunk.
#pragma once

#include <vector>

#include "codec/coding/mesh_state.h"
#include "codec/core/expected.h"
#include "codec/core/range_coder.h"
#include "codec/format/chunk_frame.h"

namespace vitrine::inline codec {

// Decodes the components, inserts them into `mesh` and returns them in coded order. Safe on hostile
// bytes. After an error, `mesh` can be destroyed safely but must not be used.
Expected<std::vector<InsertedComponent>> decode_components(MeshState& mesh, const ChunkFrame& frame,
                                                           RangeDecoder& coder);

}  // namespace vitrine::inline codec
