// SPDX-License-Identifier: Apache-2.0
// The error of each level of a `.pmesh`, as a function of the level's faces and of its bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct ErrorPoint {
  double x = 0;      // number of faces or bytes
  double error = 0;  // rms error of the displayed mesh, in % of the diagonal (single_files.h)
};

struct ErrorCurves {
  std::vector<ErrorPoint> by_faces, by_bytes;  // coarsest first
};

ErrorCurves error_curves(std::span<const std::uint8_t> pmesh, const TriangleMesh& original);

// Returns the error at `x` by log-log interpolation between two levels. Outside the range of the
// levels, extrapolates from the two nearest ones.
double error_at(const std::vector<ErrorPoint>& levels, double x);

}  // namespace vitrine::bench
