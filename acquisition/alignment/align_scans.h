// SPDX-License-Identifier: Apache-2.0
// Aligns scans of one object in several poses: finds the rigid motion of each scan into a common
// frame.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/alignment/scan_pair.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct AlignmentOptions {
  double reach = .5;       // distance in mm below which two surfaces count as one
  std::uint64_t seed = 1;  // seed of the random search; equal seeds give equal results
};

// How well two scans agree in the result.
struct PairQuality {
  std::size_t from = 0, to = 0;  // indices of the two scans
  // `overlap`: share of one scan's vertices that lie on the other scan's surface. `rms`: rms
  // distance of these vertices from that surface, in mm. `crossed`: share of one scan's sight lines
  // that the other scan's surface crosses. Shares are from 0 to 1. Each value is the larger one of
  // the two scans.
  double overlap = 0, rms = 0, crossed = 0;
};

struct Alignment {
  // The motion of each scan into the frame of the first scan; the identity for the first scan.
  std::vector<RigidMotion> motions;
  // all pairs of scans that overlap, sorted by `from`, then by `to`
  std::vector<PairQuality> pairs;
};

// Aligns 2 to 16 scans. Searches for the relative pose of each pair by matching point features
// ([RBB09]) and trying random triples of matches ([FB81]). Refines all candidates and judges each
// by the sight lines of both scans. Then chains the scans together by the pairs with the largest
// overlap, distributes the error over all pairs, and judges the pairs again. Fails with kBadInput,
// naming the pair, if the result may be wrong: if the overlap is too small, or if several poses fit
// about equally well, as for a vase.
Expected<Alignment> align_scans(std::span<const PoseScan> scans,
                                const AlignmentOptions& options = {});

}  // namespace vitrine::acquisition
