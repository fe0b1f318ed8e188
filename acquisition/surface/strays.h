// SPDX-License-Identifier: Apache-2.0
// Points that no surface goes through.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

struct Strays {
  std::vector<bool> kept;  // a point of the cloud each
  std::uint64_t outliers = 0, isolated = 0;
};

// Neighbours of a point are those of the rows next to its own, in its strand and all of the two
// steps on either side, that are closer than `reach` (mm). Outliers have fewer than three of them;
// what is left and hangs together in pieces of fewer than `smallest` points is isolated. Pieces are
// formed over rows and steps alike, so that a thin edge which shows on a few rows of many profiles
// is one. O(n).
Strays find_strays(const Cloud& cloud, double reach, std::size_t smallest);

}  // namespace vitrine
