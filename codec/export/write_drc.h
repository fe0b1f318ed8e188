// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct DrcOptions {
  // Of the bounding box, 1..30. The default is as fine as the single precision of other formats:
  // what it rounds is nothing to the error that a level states.
  int bits = 24;
  int effort = 7;  // draco_encoder's -cl: 0 fastest, 10 smallest
};

// A Draco edgebreaker file. `mesh` has faces, valid indices and no or all colours, and its
// positions fit a float, as write_mesh() makes sure. Fails (kUnsupported) with Draco's reason.
Expected<std::vector<std::uint8_t>> write_drc(const TriangleMesh& mesh,
                                              const DrcOptions& options = {});

}  // namespace vitrine
