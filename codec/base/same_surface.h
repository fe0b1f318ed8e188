// SPDX-License-Identifier: Apache-2.0
// Matches the vertices of two meshes that differ only in their order. Internal to codec/base.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

// Returns, for each vertex of `b`, the index of the same vertex in `a`. Fails (kBadInput) unless
// both meshes have the same faces, positions and attributes.
Expected<std::vector<std::uint32_t>> correspond(const BaseMesh& a, const BaseMesh& b);

}  // namespace vitrine::inline codec
