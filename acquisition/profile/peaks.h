// SPDX-License-Identifier: Apache-2.0
// Candidates for the stripe: up to two peaks a row, to the pixel.
#pragma once

#include <array>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/stripe.h"

namespace vitrine {

struct Peak {
  int u = 0;         // pixels
  int strength = 0;  // grey levels above the background, smoothed across the stripe
};

struct RowPeaks {
  int count = 0;  // 0 to 2, the stronger first
  std::array<Peak, 2> peaks;
  int valley = 0;  // of two: the least strength between them
};

// One entry a row. The background and the noise are measured in the difference itself, so that no
// threshold is to be set for a camera. Both frames are of one size.
std::vector<RowPeaks> find_peaks(const Frame& lit, const Frame& dark, const StripeOptions& options);

}  // namespace vitrine
