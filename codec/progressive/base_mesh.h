// SPDX-License-Identifier: Apache-2.0
// Level 0 as integers: what the Draco buffer of a `.pmesh` holds and a Refiner starts from.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/vec.h"

namespace vitrine {

// Real faces only. `colours` holds YCoCg-R triples (colour.h) per vertex, or nothing.
struct BaseMesh {
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  std::vector<Vec3i> colours;
};

inline Unexpected damaged_base(const std::string& what) {
  return fail(ErrorCode::kBadInput, "damaged base mesh: " + what + "; fetch the file again");
}

}  // namespace vitrine
