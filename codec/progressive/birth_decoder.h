// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "codec/core/expected.h"
#include "codec/core/range_coder.h"
#include "codec/progressive/chunk_frame.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// Decodes the components that a chunk brings whole into `mesh`; they come back in coded order.
// Safe on hostile bytes, as decode_layer().
Expected<std::vector<Newborn>> decode_births(MeshState& mesh, const ChunkFrame& frame,
                                             RangeDecoder& coder);

}  // namespace vitrine
