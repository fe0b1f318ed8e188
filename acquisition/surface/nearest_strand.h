// SPDX-License-Identifier: Apache-2.0
// Assigns each point to the nearest strand (steps.h) of a step that shows two surfaces.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Returns for each point of `strand` the index of the strand of `step` that is nearest at the
// point's row. If `step` has only one strand, returns its index for all points. Takes O(points)
// time.
std::vector<std::size_t> nearest_strands(const Cloud& cloud, std::size_t strand, std::size_t step);

}  // namespace vitrine::acquisition
