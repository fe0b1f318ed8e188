// SPDX-License-Identifier: Apache-2.0
// Averages a stripe over neighbouring rows where it is straight within its noise.
#pragma once

#include <vector>

#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {

// Smooths the stripe along the rows. Each point moves in u onto a line fitted to neighbouring rows,
// up to `reach` rows to either side. The line covers as many rows as possible, as long as they
// scatter no more than the noise does. The noise is estimated from the stripe's third differences,
// on which edges have little effect. Takes O(rows * reach) time.
void steady(std::vector<StripePoint>& stripe, int reach);

}  // namespace vitrine::acquisition
