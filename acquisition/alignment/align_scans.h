// SPDX-License-Identifier: Apache-2.0
// Finds how scans of one object in several poses lie on each other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/alignment/scan_pair.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct AlignmentOptions {
  double reach = .5;       // mm: surfaces closer than this count as the same surface
  std::uint64_t seed = 1;  // of the random search; equal seeds give equal results
};

// How two scans lie on each other in the result.
struct PairQuality {
  std::size_t from = 0, to = 0;
  double overlap = 0, rms = 0, crossed = 0;  // as in PairFit
};

struct Alignment {
  // The motion of each scan into the frame of the first scan; identity for the first.
  std::vector<RigidMotion> motions;
  std::vector<PairQuality> pairs;  // all pairs that overlap, by `from` and then `to`
};

// Finds the motions of 2 to 16 scans. Searches for the pose of each pair by point features
// ([RBB09]) and random triples ([FB81]), refines all candidates and judges each by the sight lines
// of both scans. Joins the scans by the pairs of the largest overlap. Then distributes the error
// over all pairs and judges them again. Refuses a result that may be wrong with kBadInput, and
// names the pair: too little overlap, or several poses that fit about equally well, as those of a
// vase do.
Expected<Alignment> align_scans(std::span<const PoseScan> scans,
                                const AlignmentOptions& options = {});

}  // namespace vitrine::acquisition
