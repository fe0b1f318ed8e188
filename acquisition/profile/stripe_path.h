// SPDX-License-Identifier: Apache-2.0
// Chooses the stripe among each row's peaks: the strongest chain of peaks down the image that has
// few jumps.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"

namespace vitrine::acquisition {

// Returns for each row the index of the peak that belongs to the stripe, or -1 if the row has no
// peak. A reflection that is stronger than the stripe in a few rows is not chosen, because the jump
// to the reflection costs more than these rows gain.
std::vector<int> choose_peaks(std::span<const RowPeaks> rows);

}  // namespace vitrine::acquisition
