// SPDX-License-Identifier: Apache-2.0
// Chooses one of the judged poses of a pair of scans, unless the choice is doubtful.
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
  PairFit best;  // the chosen pose; its overlap is 0 if no pose fits
};

// Returns whether the measurements contradict the pose: the surfaces cross too many sight lines, or
// the overlapping surfaces are too far apart. `reach` is the distance in mm below which two
// surfaces count as one.
bool is_contradicted(const PairFit& fit, double reach);

// Chooses the fit with the largest overlap that the measurements do not contradict. `fits` is the
// result of pair_fits().
PosesOfPair choose_pose(std::span<const PairFit> fits, double reach);

}  // namespace vitrine::acquisition
