// SPDX-License-Identifier: Apache-2.0
// Finds the rows that show a second surface, and the peak of that surface in each of them.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"

namespace vitrine::acquisition {

// Returns for each row the index of a second peak, or -1. The second peak is the one that `chosen`
// did not take. It qualifies if the image is dark between the two peaks and the second peak
// continues a line down the image. Noise, glints and a stripe parallel to the rows do not qualify.
std::vector<int> second_peaks(std::span<const RowPeaks> rows, std::span<const int> chosen);

}  // namespace vitrine::acquisition
