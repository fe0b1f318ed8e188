// SPDX-License-Identifier: Apache-2.0
// The strongest competitor of a `.pmesh` and its prefixes: a separate file for each number of
// faces. meshoptimizer simplifies the mesh and moves its vertices; Draco encodes the result with
// the best number of bits.
#pragma once

#include <optional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct CodedFile {
  double bytes = 0;
  // Rms error in % of the diagonal, measured in both directions
  // (codec/distance/surface_distance.h).
  double error = 0;
};

// Returns the rms distance between `mesh` and `original`, in % of the diagonal.
double rms_percent(const TriangleMesh& mesh, const TriangleMesh& original);

class RateCurve {
 public:
  // Keeps the points for which no other point has both fewer bytes and a smaller error. Throws if
  // fewer than twelve remain.
  explicit RateCurve(std::vector<CodedFile> points);

  // Returns the bytes at `error` by log-log interpolation. Returns nullopt outside the curve.
  std::optional<double> bytes_at(double error) const;

 private:
  std::vector<CodedFile> points_;  // sorted by ascending bytes, and thus by descending error
};

RateCurve single_files(const TriangleMesh& original);

}  // namespace vitrine::bench
