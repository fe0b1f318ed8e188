// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/choose_pose.h"

namespace vitrine::acquisition {
namespace {

// In trials at the simulated scanner, right poses crossed at most .016 of the lines. Most wrong
// ones crossed more than .03; their rms refuses the others, which overlap little.
constexpr double kMostCrossed = .03;
// In multiples of `reach`. In trials at the simulated scanner, right poses had an rms of at most
// .09 of `reach`, wrong ones of at least .34.
constexpr double kMostSpread = .3;
constexpr double kLeastOverlap = .15;
// Another pose with at least this share of the best overlap makes a pair ambiguous.
constexpr double kRival = .7;

}  // namespace

bool is_contradicted(const PairFit& fit, double reach) {
  return fit.crossed > kMostCrossed || fit.rms > kMostSpread * reach;
}

PosesOfPair choose_pose(std::span<const PairFit> fits, double reach) {
  PosesOfPair chosen;
  for (const PairFit& fit : fits) {
    if (is_contradicted(fit, reach) || fit.overlap < kLeastOverlap) continue;
    if (chosen.verdict == PoseVerdict::kNone) {
      chosen = {PoseVerdict::kAccepted, fit};
    } else if (fit.overlap >= kRival * chosen.best.overlap) {
      chosen.verdict = PoseVerdict::kAmbiguous;
    }
  }
  return chosen;
}

}  // namespace vitrine::acquisition
