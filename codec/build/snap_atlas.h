// SPDX-License-Identifier: Apache-2.0
// Rounds the texture coordinates of a base mesh to a coarse lattice, so that they take few bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

struct SnappedCoordinates {
  std::vector<Vec2i> at;  // multiples of `step`
  std::int32_t step = 1;  // a power of two
};

// Rounds `at`, the coordinates of each wedge, to a lattice. A picture has at most kMaxAtlasSide
// units per side. `faces` holds the wedges of each face. The lattice's step is at most 1/32 of the
// mean edge length in the picture and at most 1024 units. It is also so small that rounding neither
// halves nor doubles the area of any face. A wedge may move up to two steps away from its nearest
// lattice point if that keeps the areas of its faces.
SnappedCoordinates snap_coordinates(std::span<const Triangle> faces, std::span<const Vec2> at);

}  // namespace vitrine::inline codec
