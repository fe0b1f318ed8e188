// SPDX-License-Identifier: Apache-2.0
// Measures the distance between a scan and the ground truth.
#pragma once

#include "support/product_names.h"
#include "truth.h"

namespace vitrine::bench {

struct Distances {
  double rms = 0, p95 = 0;  // in mm; p95 is the 95th percentile
  double within = 0;        // share of points at most kCovered from the other surface
};
// A point that is at most this far from the other surface, in mm, counts as covered by it.
inline constexpr double kCovered = 0.1;

struct Accuracy {
  Distances scan_to_truth;  // distances from all points of the scan
  Distances truth_to_scan;  // distances from the visible part of the truth
  double rms() const;       // rms() and p95() return the larger value of both directions
  double p95() const;
};

Distances distances(const TriangleMesh& from, const TriangleMesh& to);
Accuracy accuracy(const TriangleMesh& scan, const Truth& truth);

// Moves the scan onto the truth along z only. A scanner does not know the height of its table, so
// this offset is not an error of the scan.
TriangleMesh at_height_of(const TriangleMesh& scan, const TriangleMesh& truth);
// Moves the scan onto the truth by rigid registration, starting at its present position.
TriangleMesh aligned(const TriangleMesh& scan, const TriangleMesh& truth);

}  // namespace vitrine::bench
