// SPDX-License-Identifier: Apache-2.0
// The strongest rival of a prefix: for each number of faces one file of its own, simplified by
// meshoptimizer with updated positions and coded by Draco at the best number of bits.
#pragma once

#include <optional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct RatePoint {
  double bytes = 0;
  double error = 0;  // rms in % of the diagonal, both ways (codec/mesh/surface_distance.h)
};

// The error of `mesh` against `original`.
double rms_percent(const TriangleMesh& mesh, const TriangleMesh& original);

class RateCurve {
 public:
  // Keeps the points that no other one beats in both figures; needs twelve of them.
  explicit RateCurve(std::vector<RatePoint> points);

  // Bytes at `error`, log-log between two points; none beyond them.
  std::optional<double> bytes_at(double error) const;

 private:
  std::vector<RatePoint> points_;  // bytes ascend, errors descend
};

RateCurve single_files(const TriangleMesh& original);

}  // namespace vitrine::bench
