// SPDX-License-Identifier: Apache-2.0
// Gaps along a profile: the small ones are filled, at the others its surface ends.
#pragma once

#include <cstdint>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// Rows that are missing between two points which are joined (eq. 5) and no further apart than
// `largest_hole` mm get points in between, linear in rho (and in lateral and z), flagged kFilled. A
// point that is not joined to the one before it, or lies further off than `spacing.bridge`, is
// flagged kApart. Returns how many points were filled in.
std::uint64_t fill_gaps(Profile& profile, double largest_hole, const Spacing& spacing);

}  // namespace vitrine
