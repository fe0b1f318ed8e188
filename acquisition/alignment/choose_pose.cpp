// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/choose_pose.h"

namespace vitrine::acquisition {
namespace {

// Largest share of crossed sight lines of a correct pose. In trials with the simulated scanner,
// correct poses crossed at most 0.016 of the lines. Most wrong poses crossed more than 0.03. The
// remaining wrong poses overlapped little and were rejected by their rms distance.
constexpr double kMostCrossed = .03;
// Largest rms distance of a correct pose, in multiples of `reach`. In trials with the simulated
// scanner, correct poses had at most 0.09, wrong poses at least 0.34.
constexpr double kMostSpread = .3;
constexpr double kLeastOverlap = .15;
// A pair is ambiguous if another pose has at least this share of the best pose's overlap.
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
