// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Merges the vertices that are repeated along a seam: where exactly two border edges, of whatever
// direction, lie between the same two points (of the same colours; `colours` may be empty) and
// their faces are not each other's copy or back, the ends of the two become one vertex. What only
// touches in points, lies along an inner edge, or meets in threes stays apart. The vertices that
// remain keep their order. Returns the new index of each old vertex. The positions that faces use
// must be finite. O(n log n).
std::vector<std::uint32_t> weld_seams(std::vector<Vec3>& positions, std::vector<Colour>& colours,
                                      std::span<const Triangle> faces);

}  // namespace vitrine
