// SPDX-License-Identifier: Apache-2.0
// Chooses among the judged poses of a pair of scans, or refuses to.
#pragma once

#include <span>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

enum class PoseVerdict {
  kAccepted,
  kAmbiguous,  // other poses fit about as well
  kNone,       // no pose fits
};

struct PosesOfPair {
  PoseVerdict verdict = PoseVerdict::kNone;
  PairFit best;  // has no overlap if no pose fits
};

// Returns whether the measurements rule the pose out: sight lines are crossed, or what overlaps
// does not lie close together.
bool is_contradicted(const PairFit& fit, double reach);

// Chooses the fit of the largest overlap that nothing contradicts. `fits` are those of pair_fits().
PosesOfPair choose_pose(std::span<const PairFit> fits, double reach);

}  // namespace vitrine::acquisition
