// SPDX-License-Identifier: Apache-2.0
// Writes a mesh as a Draco file.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct DrcOptions {
  // Bits per coordinate of the bounding box, 1 to 30. The default is about as fine as single
  // precision, so the rounding is negligible compared with a level's error.
  int bits = 24;
  // Compression level, like -cl of draco_encoder: 0 is fastest, 10 gives the smallest file.
  int effort = 7;
};

// Returns a Draco edgebreaker file [Draco]. `mesh` must have faces, valid indices, positions that
// fit a float, and either no colours or one per vertex; write_mesh() checks this. Fails
// (kUnsupported) with the error message of Draco.
Expected<std::vector<std::uint8_t>> write_drc(const TriangleMesh& mesh,
                                              const DrcOptions& options = {});

}  // namespace vitrine::inline codec
