// SPDX-License-Identifier: Apache-2.0
// The charts of a texture: sets of faces that are connected across edges that are not seams.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Returns the chart of each wedge. A chart is identified by the lowest wedge number in it. Returns
// an empty list if `refiner` has no texture coordinates.
std::vector<WedgeId> charts_of(const Refiner& refiner);

// Returns the number of charts, 0 if `refiner` has no texture coordinates.
std::uint32_t chart_count(const Refiner& refiner);

}  // namespace vitrine::inline codec
