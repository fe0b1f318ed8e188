// SPDX-License-Identifier: Apache-2.0
// The steps by which find_stripe() turns the peaks of an image into a stripe.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/peaks.h"
#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

// Chooses the stripe among each row's peaks: the strongest chain of peaks down the image that has
// few jumps.
//
// Returns for each row the index of the peak that belongs to the stripe, or -1 if the row has no
// peak. A reflection that is stronger than the stripe in a few rows is not chosen, because the jump
// to the reflection costs more than these rows gain.
std::vector<int> choose_peaks(std::span<const RowPeaks> rows);

// Finds the rows that show a second surface.
//
// Returns for each row the index of the peak that shows a second surface, or -1. This is the peak
// of the row that `chosen` does not name. The image must be dark between the two peaks, and the
// second peak must continue a line down the image. These conditions exclude noise, glints and a
// stripe parallel to the rows.
std::vector<int> second_peaks(std::span<const RowPeaks> rows, std::span<const int> chosen);

// Smooths the stripe along the rows. Each point moves in u onto a line fitted to neighbouring rows,
// up to `reach` rows to either side. The line covers as many rows as possible, as long as they
// scatter no more than the noise does. The noise is estimated from the stripe's third differences,
// on which edges have little effect. Takes O(rows * reach) time.
void steady(std::vector<StripePoint>& stripe, int reach);

}  // namespace vitrine::acquisition
