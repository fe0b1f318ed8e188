// SPDX-License-Identifier: Apache-2.0
// Internal to codec/base: maps the vertices of a mesh to those of the same mesh in another order.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

// Returns for each vertex of `b` the corresponding vertex of `a`. Corresponding faces, positions
// and attributes are equal. Fails (kBadInput) if the two meshes are not the same surface.
Expected<std::vector<std::uint32_t>> correspond(const BaseMesh& a, const BaseMesh& b);

}  // namespace vitrine::inline codec
