// SPDX-License-Identifier: Apache-2.0
// Level 0 as integers: what the Draco buffer of a `.pmesh` holds and a Refiner starts from.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/fill_in.h"
#include "codec/core/vec.h"

namespace vitrine {

// Real faces only. `colours` holds YCoCg-R triples (colour.h) per vertex, or nothing.
struct BaseMesh {
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  std::vector<Vec3i> colours;
};

inline Unexpected damaged_base(std::string_view what) {
  return fail(ErrorCode::kBadInput, join({"damaged base mesh: ", what, "; fetch the file again"}));
}

}  // namespace vitrine
