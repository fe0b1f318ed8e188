// SPDX-License-Identifier: Apache-2.0
// The error of each level of a `.pmesh`, over its faces and over its bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

struct LevelError {
  double x = 0;      // faces or bytes
  double error = 0;  // as displayed: rms in % of the diagonal (single_files.h)
};

struct LevelErrors {
  std::vector<LevelError> by_faces, by_bytes;  // coarsest first
};

LevelErrors level_errors(std::span<const std::uint8_t> pmesh, const TriangleMesh& original);

// The error at `x`, log-log between two levels, along the outermost pair beyond them.
double error_at(const std::vector<LevelError>& levels, double x);

}  // namespace vitrine::bench
