// SPDX-License-Identifier: Apache-2.0
// What one would publish without progressive meshes: for each level of detail a file of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct SingleFile {
  std::uint64_t bytes = 0;
  double rms_error = 0;  // against the original, the larger of both directions; model units
};

// Files of about `fewest` to all faces of `original`, simplified by meshoptimizer (which moves no
// vertex) and coded by Draco as small as it can on each grid of 8 to `most_bits` bits, without
// those that another one beats in both: bytes ascend, errors descend. `progress` takes 0..1.
std::vector<SingleFile> single_files(const TriangleMesh& original, std::size_t fewest,
                                     int most_bits, const std::function<void(double)>& progress);

}  // namespace vitrine
