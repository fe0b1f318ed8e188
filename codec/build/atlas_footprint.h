// SPDX-License-Identifier: Apache-2.0
// Follows the texture coordinates of a model from its base mesh to full resolution. Packs the
// charts so that they do not overlap at any level.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/build/model_encoder.h"
#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

struct PlacedAtlas {
  BaseAtlas base;          // base mesh's atlas, with final coordinates
  std::uint32_t side = 0;  // width and height of the picture, in units of texture coordinates
  // The faces at full resolution: the ids of their vertices in the hierarchy
  // (EncodedModel::fine_ids), and the texture coordinates of their corners.
  std::vector<Triangle> faces;
  std::vector<std::array<Vec2i, 3>> coordinates;
};

// Draws an atlas on the base mesh of `model` and packs it. Fails (kLimit) if the base mesh has more
// than 20,000 faces, or if the charts do not fit in a picture.
Expected<PlacedAtlas> place_atlas(const EncodedModel& model);

}  // namespace vitrine::inline codec
