// SPDX-License-Identifier: Apache-2.0
// Rounds the texture coordinates of a base mesh to a coarse lattice, on which they cost few bytes.
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

// Rounds `at`, the coordinates of each wedge, in units of which a picture has at most
// kMaxAtlasSide. `faces` holds the wedges of each face. The step is at most 1/32 of the mean edge
// in the picture, at most 1024, and so small that rounding neither halves nor doubles the area of a
// face. A wedge may move to a point up to two steps from the nearest one, if that saves its faces.
SnappedCoordinates snap_coordinates(std::span<const Triangle> faces, std::span<const Vec2> at);

}  // namespace vitrine::inline codec
