// SPDX-License-Identifier: Apache-2.0
// Which of the peaks that are not the stripe's first surface show a second one.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"

namespace vitrine {

// One index a row into its peaks, -1 where there is none: the peak that `chosen` left, if it is
// dark between the two and the peak is part of a line down the image, of peaks chosen or not.
// Noise, glints and a stripe that runs along the rows show none.
std::vector<int> second_peaks(std::span<const RowPeaks> rows, std::span<const int> chosen);

}  // namespace vitrine
