// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/layer_pass.h"

namespace vitrine {

// Decodes one chunk into `mesh` and returns the splits it applied, in coded order. `planes` is not
// empty for the chunk that ends the common prefix: the region labels follow the splits there.
// Safe on hostile bytes; after an error `mesh` is a manifold in memory, but of no use.
Expected<std::vector<Split>> decode_layer(MeshState& mesh, const ChunkFrame& frame,
                                          std::span<const RegionPlane> planes,
                                          std::span<const std::uint8_t> bytes) noexcept;

}  // namespace vitrine
