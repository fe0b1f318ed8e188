// SPDX-License-Identifier: Apache-2.0
// Writes a mesh as a Draco file.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct DrcOptions {
  // Bits per coordinate of the bounding box, 1 to 30. The default is as fine as the single
  // precision of the other formats, so the rounding is negligible compared with a level's error.
  int bits = 24;
  // Compression level, as in draco_encoder -cl. 0 is fastest, 10 gives the smallest file.
  int effort = 7;
};

// Returns a Draco edgebreaker file [Draco]. `mesh` must have passed the checks of write_mesh(): it
// has faces, valid indices, no colours or one per vertex, and positions that fit a float. Fails
// (kUnsupported) with the reason that Draco gives.
Expected<std::vector<std::uint8_t>> write_drc(const TriangleMesh& mesh,
                                              const DrcOptions& options = {});

}  // namespace vitrine::inline codec
