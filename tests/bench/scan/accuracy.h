// SPDX-License-Identifier: Apache-2.0
// How far a scan is from the truth.
#pragma once

#include "truth.h"

namespace vitrine::bench {

struct Distances {
  double rms = 0, p95 = 0;  // mm
  double within = 0;        // share that is closer than kCovered
};
inline constexpr double kCovered = 0.1;  // mm

struct Accuracy {
  Distances scan_to_truth;  // all of the scan
  Distances truth_to_scan;  // of the truth, what is seen
  double rms() const;       // the larger of the two; so is p95
  double p95() const;
};

Distances distances(const TriangleMesh& from, const TriangleMesh& to);
Accuracy accuracy(const TriangleMesh& scan, const Truth& truth);

// A scanner does not know how high its table is: the scan, moved along z alone onto the truth.
TriangleMesh at_height_of(const TriangleMesh& scan, const TriangleMesh& truth);
// Moved rigidly, from where it is.
TriangleMesh aligned(const TriangleMesh& scan, const TriangleMesh& truth);

}  // namespace vitrine::bench
