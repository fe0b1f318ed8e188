// SPDX-License-Identifier: Apache-2.0
// Finds the rows that show a second surface, and the peak of that surface in each of them.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"

namespace vitrine::acquisition {

// Returns for each row the index of the peak that shows a second surface, or -1. This is the peak
// of the row that `chosen` does not name. The image must be dark between the two peaks, and the
// second peak must continue a line down the image. These conditions exclude noise, glints and a
// stripe parallel to the rows.
std::vector<int> second_peaks(std::span<const RowPeaks> rows, std::span<const int> chosen);

}  // namespace vitrine::acquisition
