// SPDX-License-Identifier: Apache-2.0
// Gaps along a strand: the small ones are filled, at the others its surface ends.
#pragma once

#include <cstdint>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// Rows that are missing between two points which are joined (eq. 5, or else a step that is like the
// one before or after it: a surface may be grazed all along) and no further apart than
// `largest_hole` mm get points in between, linear in rho (and in lateral and z), flagged kFilled. A
// point that is not joined to the one before it, or has a larger gap before it, is flagged kApart.
// Returns how many points were filled in.
std::uint64_t fill_gaps(Profile& strand, double largest_hole, const Spacing& spacing);

}  // namespace vitrine
