// SPDX-License-Identifier: Apache-2.0
// Fills small gaps along a strand, and marks larger gaps as ends of the surface.
#pragma once

#include <cstdint>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Fills gaps in a strand: interpolates points in missing rows, linearly in rho, lateral and z, and
// flags them kFilled. The two ends of a gap must be joined and at most `largest_hole` mm apart. Two
// points are joined by [WLL] eq. 5. On grazing surfaces, two points are also joined if the step
// between them resembles the step before or after. Flags a point kApart if it is not joined to the
// point before it or follows a larger gap. Returns the number of points added.
std::uint64_t fill_gaps(Profile& strand, double largest_hole, const Spacing& spacing);

}  // namespace vitrine::acquisition
