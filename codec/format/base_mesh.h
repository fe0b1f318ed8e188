// SPDX-License-Identifier: Apache-2.0
// The base mesh (level 0) with integer positions and attributes, as stored in the Draco buffer of a
// `.pmesh`. Refinement starts from the base mesh.
#pragma once

#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/fill_in.h"
#include "codec/core/vec.h"
#include "codec/core/vec2.h"
#include "codec/format/lattice_attributes.h"

namespace vitrine::inline codec {

// The texture coordinates of a base mesh. A wedge is a run of face corners at one vertex that share
// their coordinates. Empty if the model has no texture.
struct BaseAtlas {
  std::vector<Triangle> wedges;  // per face: the wedges of its corners
  // Integer coordinates of each wedge; a picture is TextureInfo::side units wide.
  std::vector<Vec2i> coordinates;

  bool empty() const { return wedges.empty(); }
};

// The base mesh. `faces` holds only the faces of the surface, not those that close boundary loops.
struct BaseMesh {
  std::vector<Vec3i> positions;
  std::vector<Triangle> faces;
  LatticeAttributes attributes;
  BaseAtlas atlas;
};

inline Unexpected damaged_base(std::string_view what) {
  return fail(ErrorCode::kBadInput, join({"damaged base mesh: ", what, "; fetch the file again"}));
}

}  // namespace vitrine::inline codec
