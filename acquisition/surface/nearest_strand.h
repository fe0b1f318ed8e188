// SPDX-License-Identifier: Apache-2.0
// Where a step shows two surfaces, a point belongs to the one that is nearer.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// For each point of `strand` the strand of `step` that is nearest to it at its row; if there is
// only one, that. O(points).
std::vector<std::size_t> nearest_strands(const Cloud& cloud, std::size_t strand, std::size_t step);

}  // namespace vitrine
