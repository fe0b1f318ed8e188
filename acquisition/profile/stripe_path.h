// SPDX-License-Identifier: Apache-2.0
// Which of a row's peaks is the stripe: the chain down the image that is strong and jumps little.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"

namespace vitrine {

// One index a row into its peaks, -1 where there are none. A reflection that is stronger than the
// stripe for some rows does not move the chain to it: a jump costs what the difference in strength
// of several rows gains.
std::vector<int> choose_peaks(std::span<const RowPeaks> rows);

}  // namespace vitrine
