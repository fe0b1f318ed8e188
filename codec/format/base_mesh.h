// SPDX-License-Identifier: Apache-2.0
// The base mesh (level 0) with integer positions and attributes, as stored in the Draco buffer of a
// `.pmesh`. A Refiner starts from it.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/fill_in.h"
#include "codec/core/vec.h"
#include "codec/format/lattice_attributes.h"

namespace vitrine::inline codec {

// Holds only the faces of the surface, not those that close boundary loops.
struct BaseMesh {
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  LatticeAttributes attributes;
};

inline Unexpected damaged_base(std::string_view what) {
  return fail(ErrorCode::kBadInput, join({"damaged base mesh: ", what, "; fetch the file again"}));
}

}  // namespace vitrine::inline codec
