// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Merges vertices of exactly the same position and colour (`colours` may be empty); those that
// remain keep the order of their first appearance. Returns the new index of each old vertex. The
// positions must be finite.
std::vector<std::uint32_t> weld(std::vector<Vec3>& positions, std::vector<Colour>& colours);

// The same by position alone: the colours of those that become one are averaged in linear light.
std::vector<std::uint32_t> weld_and_blend(std::vector<Vec3>& positions,
                                          std::vector<Colour>& colours);

}  // namespace vitrine
