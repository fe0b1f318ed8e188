// SPDX-License-Identifier: Apache-2.0
// Makes the files that a museum would publish without progressive meshes: one file per level of
// detail.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::server {

struct SingleFile {
  std::uint64_t bytes = 0;
  // RMS distance to the original, the larger of both directions, in model units.
  double rms_error = 0;
};

// Returns files with face counts from about `fewest` to that of `original`. meshoptimizer
// simplifies the meshes without moving vertices. Draco encodes each mesh at its highest effort, on
// each grid of 8 to `most_bits` bits per coordinate. Omits a file if another file is both smaller
// and more accurate, so bytes ascend and errors descend. Calls `progress` with values from 0 to 1.
std::vector<SingleFile> single_files(const TriangleMesh& original, std::size_t fewest,
                                     int most_bits, const std::function<void(double)>& progress);

}  // namespace vitrine::server
