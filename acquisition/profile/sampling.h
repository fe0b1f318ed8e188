// SPDX-License-Identifier: Apache-2.0
// Reduces the points of profiles. Source: [WLL] section 2.3, eq. 3 and 4.
#pragma once

#include <span>

#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

enum class SamplingMethod {
  kEquidistant,  // keeps every L-th point, starting with the first
  kPaper,        // averages by [WLL] eq. 3 and 4, described below
  kAdaptive,
};

struct SamplingOptions {
  SamplingMethod method = SamplingMethod::kAdaptive;
  int window = 5;  // the length L, in points: 5, 10, 15 or 20; 1 keeps all points
  // Calibrated standard deviation of rho, in mm. Only kAdaptive uses it.
  double noise = 0;
};

// kPaper follows [WLL] literally. Consecutive blocks have L points; the last block may have fewer.
// For the n values of rho in a block, eq. 3 and 4 define:
//   mean = sum rho_i / n,   s² = sum (rho_i - mean)² / (n - 1).
// If every |rho_i - mean| <= 3 s, the block becomes one point (mean rho, theta, mean z). Otherwise
// all its points stay. |rho_i - mean| / s is at most (n - 1) / sqrt(n). For L <= 10, therefore, no
// value exceeds 3 s, and kPaper is plain averaging.
//
// kAdaptive concentrates points on detail. Over all profiles it keeps at most as many points as
// kEquidistant plus the ends of the profiles' parts. Each kept point represents a window of up to 2
// L neighbours. The algorithm starts with windows of one point. It repeatedly merges two
// neighbouring windows of one profile: those whose points deviate least from their common line in
// (rho, z). A deviation within `noise` counts as zero. Among equal deviations, the merge with the
// fewest points comes first. The kept points start as the means of the windows. At the end of a
// part (PointFlag kApart), a point lies instead on its window's line at the outermost position, so
// that parts do not shrink. Finally the points move so that the polyline through them fits all
// original points best (fit_polyline.h). Profiles with more than 2,000,000 points in total are
// processed in blocks. Takes O(n log n) time.
//
// A kept point gets the row in the middle of its window, so rows stay ascending. The point is
// flagged kFilled if all points of its window are flagged kFilled. It gets every other flag that
// any point of its window has.
void sample(std::span<Profile> profiles, const SamplingOptions& options);

}  // namespace vitrine::acquisition
