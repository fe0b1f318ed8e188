// SPDX-License-Identifier: Apache-2.0
// Fewer points a profile (paper, section 2.3, eq. 3-4).
#pragma once

#include <span>

#include "acquisition/profile/profile.h"

namespace vitrine {

enum class SamplingMethod {
  kEquidistant,  // every L-th point, from the first
  kPaper,        // see below
  kAdaptive,
};

struct SamplingOptions {
  SamplingMethod method = SamplingMethod::kAdaptive;
  int window = 5;    // L in points: 5, 10, 15, 20; 1 keeps all
  double noise = 0;  // mm: standard deviation of rho, as calibrated; only kAdaptive asks for it
};

// kPaper, to the letter. Blocks of L points follow each other, the last may be shorter. Of a
// block's n rho's (eq. 3-4)
//   mean = sum rho_i / n,   s² = sum (rho_i - mean)² / (n - 1);
// if every |rho_i - mean| <= 3 s the block becomes one point (mean rho, theta, mean z), otherwise
// all its points stay. The largest possible |rho_i - mean| / s is (n - 1) / sqrt(n): up to L = 10
// nothing is ever beyond 3 s, and this is plain averaging.
//
// kAdaptive keeps at most as many points of all profiles as kEquidistant (and the ends of the
// profiles' parts) and spends them on detail; profiles of more than 2,000,000 points share them by
// blocks. Each point stands for a window of neighbours; windows differ in length, up to 2 L points.
// Starting from single points, those two neighbouring windows of any profile are joined that
// together deviate least from their common line in (rho, z); what is within `noise` does not count
// as deviation, and among equals the shortest are joined first. The points begin as the windows'
// means, at the ends of a part (ProfilePoint flag kApart) on the window's line at its outermost
// point: nothing shrinks. Then they move so that the polyline through them fits all points best
// (fit_polyline.h): on a bend, means lie on the inner side. O(n log n).
//
// A point has the row in the middle of its window, so that rows stay ascending; it is kFilled if
// all of its window is, and has any other flag if one of them has it.
void sample(std::span<Profile> profiles, const SamplingOptions& options);

}  // namespace vitrine
