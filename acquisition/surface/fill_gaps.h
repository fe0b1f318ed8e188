// SPDX-License-Identifier: Apache-2.0
// Fills small gaps along a strand; at larger gaps the surface ends.
#pragma once

#include <cstdint>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Fills gaps: interpolates points in missing rows, linearly in rho, lateral and z, and flags them
// kFilled. The two ends of a gap must be joined and at most `largest_hole` mm apart. Two points are
// joined by [WLL] eq. 5, or if the step between them resembles the step before or after it (grazing
// surfaces). A point that is not joined to the point before it, or follows a larger gap, is flagged
// kApart. Returns the number of points added.
std::uint64_t fill_gaps(Profile& strand, double largest_hole, const Spacing& spacing);

}  // namespace vitrine::acquisition
