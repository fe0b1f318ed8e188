// SPDX-License-Identifier: Apache-2.0
// Smooths strands within the sensor's noise.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Smooths the scan: moves each point in rho onto a quadratic surface fitted to the rows and steps
// around the point. If a step has two strands, the fit uses the strand whose rho is nearer. The fit
// tries a few window sizes, and uses the largest window that is complete and whose rms residual is
// at most 1.5 times `noise` (mm). If no window qualifies, as at edges, the point does not move.
// Smoothing therefore removes no detail that is larger than the noise. `strands` are sorted by
// theta over one revolution, at equal steps, with points `spacing.rows` apart. Returns the number
// of points moved. Takes O(n) time.
std::uint64_t smooth(std::vector<Profile>& strands, double noise, const Spacing& spacing);

}  // namespace vitrine::acquisition
