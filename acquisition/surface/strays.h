// SPDX-License-Identifier: Apache-2.0
// Finds outliers and isolated points, which belong to no surface.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

struct Strays {
  std::vector<bool> kept;  // one flag for each point of the cloud
  std::uint64_t outliers = 0, isolated = 0;
};

// Finds points that do not belong to the surface. The neighbours of a point are closer to it than
// `reach` (mm). They are among the two points before and the two after it on its own strand, and
// among the two points above and the two below its row on each strand of the two steps on either
// side. Points with fewer than three neighbours are outliers. Among the other points, connected
// pieces with fewer than `smallest` points are isolated. Pieces extend over rows and steps alike,
// so a thin edge that shows on a few rows of many profiles is one piece. Takes O(n) time.
Strays find_strays(const Cloud& cloud, double reach, std::size_t smallest);

}  // namespace vitrine::acquisition
