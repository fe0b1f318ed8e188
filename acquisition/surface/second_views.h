// SPDX-License-Identifier: Apache-2.0
// Drops points beyond the axis if the scan also saw them half a revolution earlier or later, when
// the view was better.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Returns one flag for each point: whether to keep the point. A point with negative rho is dropped
// if a point with positive rho is closer than `reach` mm, because the two sheets would not form one
// surface. Takes O(n log n) time.
std::vector<bool> first_views(const Cloud& cloud, double reach);

}  // namespace vitrine::acquisition
