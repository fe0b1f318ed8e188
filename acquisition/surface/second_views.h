// SPDX-License-Identifier: Apache-2.0
// Drops points beyond the axis that were seen better half a revolution earlier or later.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Returns one flag for each point. It is false for a point with negative rho if a point with
// positive rho is closer than `reach` mm, because the two sheets would not form one surface. It is
// true for all other points. O(n log n).
std::vector<bool> first_views(const Cloud& cloud, double reach);

}  // namespace vitrine::acquisition
