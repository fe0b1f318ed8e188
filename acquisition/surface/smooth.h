// SPDX-License-Identifier: Apache-2.0
// Takes the sensor's noise out of the strands, and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/cloud.h"

namespace vitrine {

// Each point moves in rho onto the quadratic surface that is fitted to the rows and steps around
// it, of two strands in a step to the one that is nearer in rho: the largest of a few windows that
// is complete and scatters about its surface no more than `noise` (mm) explains. Where none does,
// at edges, steps and borders, a point stays as it was measured; so what is smoothed away is no
// larger than the noise. `strands` are in order of theta over one turn, at equal steps, with points
// `spacing.rows` apart. Returns how many points moved. O(n).
std::uint64_t smooth(std::vector<Profile>& strands, double noise, const Spacing& spacing);

}  // namespace vitrine
