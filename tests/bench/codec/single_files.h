// SPDX-License-Identifier: Apache-2.0
// The strongest competitor of the prefixes of a `.pmesh`: a separate file for each number of faces,
// simplified by meshoptimizer with updated positions and encoded by Draco with the best number of
// bits.
#pragma once

#include <optional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct CodedFile {
  double bytes = 0;
  double error = 0;  // rms in % of the diagonal, both ways (codec/distance/surface_distance.h)
};

// Returns the rms distance between `mesh` and `original`, in % of the diagonal.
double rms_percent(const TriangleMesh& mesh, const TriangleMesh& original);

class RateCurve {
 public:
  // Keeps the points that no other point beats in both bytes and error. Throws if fewer than twelve
  // remain.
  explicit RateCurve(std::vector<CodedFile> points);

  // Returns the bytes at `error` by log-log interpolation; nullopt outside the curve.
  std::optional<double> bytes_at(double error) const;

 private:
  std::vector<CodedFile> points_;  // in order of ascending bytes and descending errors
};

RateCurve single_files(const TriangleMesh& original);

}  // namespace vitrine::bench
