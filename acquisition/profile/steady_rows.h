// SPDX-License-Identifier: Apache-2.0
// Averages a stripe along its rows where it is straight within its noise.
#pragma once

#include <vector>

#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

// Smooths the stripe along the rows. Each point moves in u onto the line through the largest set of
// neighbouring rows whose scatter about the line matches the noise. The set extends up to `reach`
// rows to either side. The noise is estimated from the stripe's third differences, which are robust
// to edges. O(rows * reach).
void steady(std::vector<StripePoint>& stripe, int reach);

}  // namespace vitrine::acquisition
