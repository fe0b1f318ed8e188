// SPDX-License-Identifier: Apache-2.0
// Internal to codec/base: finds which vertex is which in two numberings of one mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"

namespace vitrine {

// For each vertex of `b` its number in `a`, such that faces, positions and colours correspond.
// Fails (kBadInput) where the two are not the same surface.
Expected<std::vector<std::uint32_t>> correspond(const BaseMesh& a, const BaseMesh& b);

}  // namespace vitrine
