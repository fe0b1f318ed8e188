// SPDX-License-Identifier: Apache-2.0
// Codes the texture coordinates of a base mesh (codec/FORMAT.md section 8.2). Codes which edges are
// seams, then the coordinates of each wedge. Predicts coordinates as if triangles had the same
// shape in the picture as in space. Coordinates that are multiples of a power of two take fewer
// bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

// `base` must have an atlas whose coordinates are between 0 and kMaxAtlasSide.
std::vector<std::uint8_t> encode_atlas(const BaseMesh& base);

// Returns the atlas of `base`. The faces of `base` must be those of the encoded mesh, in the same
// order. Wedges are numbered in the order of their first corners. Fails (kBadInput) if the faces
// are not a manifold or a coordinate is out of bounds. Safe on hostile bytes.
Expected<BaseAtlas> decode_atlas(std::span<const std::uint8_t> bytes, const BaseMesh& base);

}  // namespace vitrine::inline codec
