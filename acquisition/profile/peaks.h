// SPDX-License-Identifier: Apache-2.0
// Finds candidates for the stripe: up to two peaks in each row, to the nearest pixel.
#pragma once

#include <array>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

struct Peak {
  int u = 0;         // column, in pixels
  int strength = 0;  // grey levels above the background, smoothed across the stripe
};

struct RowPeaks {
  int count = 0;  // 0 to 2; the stronger peak comes first
  std::array<Peak, 2> peaks;
  int valley = 0;  // if there are two peaks: the least strength between them
};

// Finds the peaks of each row and returns one entry for each row. Background and noise are
// estimated from the difference of the two frames, so no threshold depends on the camera. Both
// frames must have the same size.
std::vector<RowPeaks> find_peaks(const Frame& lit, const Frame& dark, const StripeOptions& options);

}  // namespace vitrine::acquisition
