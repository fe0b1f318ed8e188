// SPDX-License-Identifier: Apache-2.0
// Draws the pictures of a display atlas from the materials and pictures of the source.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/vec2.h"
#include "codec/format/manifest.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct BakedPicture {
  PictureRole role = PictureRole::kBaseColour;
  std::uint32_t side = 0;           // width and height in pixels
  std::vector<std::uint8_t> bytes;  // contents of a WebP file
};

struct BakedTexture {
  // The coarsest picture of colours comes first. The others follow in ascending order of side, then
  // of role. The coarsest picture of a role has at most 256 pixels a side, and each further one has
  // twice the side of the one before. If one of them has over 640 and at most 1280 pixels a side,
  // there is also a picture with three quarters of that side.
  std::vector<BakedPicture> pictures;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  double alpha_cutoff = 0.5;
  bool is_double_sided = false, is_unlit = false;
  // One line for each picture of the source that was left out, with the reason and the next step.
  std::vector<std::string> notes;
};

// The place of a face in the display atlas: the coordinates of its corners, from (0, 0) in the
// picture's upper left corner to (1, 1) in its lower right corner.
using DisplayFace = std::array<Vec2, 3>;

// Bakes the textures of `mesh` into pictures of the display atlas. `texturing` belongs to the faces
// of `mesh`, which have the same order as `display`. The finest picture has about as many texels as
// the source; the picture of occlusion, roughness and metalness has a quarter as many.
//
// A picture that cannot be decoded is left out, and a note names it. Fails (kUnsupported) only if
// libwebp refuses a picture. Call this in the sandbox if the pictures are untrusted.
Expected<BakedTexture> bake(const TriangleMesh& mesh, Texturing texturing,
                            std::span<const DisplayFace> display);

}  // namespace vitrine::inline codec
