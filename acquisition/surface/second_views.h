// SPDX-License-Identifier: Apache-2.0
// What the laser plane meets beyond the axis has been seen better, half a turn earlier or later.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// False for each point with negative rho that has a point with positive rho closer than `reach` mm:
// two sheets over each other would not be one surface. True for all others. O(n log n).
std::vector<bool> first_views(const Cloud& cloud, double reach);

}  // namespace vitrine
