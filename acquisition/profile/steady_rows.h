// SPDX-License-Identifier: Apache-2.0
// Averages a stripe along its rows where it is straight within its own noise.
#pragma once

#include <vector>

#include "acquisition/profile/stripe.h"

namespace vitrine {

// The noise is that of the stripe itself, from its third differences (robust: edges do not count).
// Each point moves in u onto the line through the rows around it: the most rows, up to `reach` on
// either side, whose scatter about the line is that noise. O(rows * reach).
void steady(std::vector<StripePoint>& stripe, int reach);

}  // namespace vitrine
