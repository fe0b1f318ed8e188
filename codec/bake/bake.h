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
  // The coarsest picture of colours comes first. The other pictures follow in ascending order of
  // side, then of role. The coarsest picture of a role has at most 256 pixels per side. Each finer
  // picture of the role has twice the side of the previous one. If one of them has a side of 641 to
  // 1280 pixels, there is also a picture with three quarters of that side.
  std::vector<BakedPicture> pictures;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  double alpha_cutoff = 0.5;
  bool is_double_sided = false, is_unlit = false;
  // One line for each picture of the source that was left out, with the reason and advice.
  std::vector<std::string> notes;
};

// The place of a face in the display atlas: the coordinates of its corners, from (0, 0) in the
// picture's upper left corner to (1, 1) in its lower right corner.
using DisplayFace = std::array<Vec2, 3>;

// Bakes the textures of `mesh` into pictures of the display atlas. `texturing` and `display`
// describe the faces of `mesh`, in the same order. The finest picture has about as many texels as
// the source. The picture of occlusion, roughness and metalness has a quarter of this number.
//
// A picture that cannot be decoded is left out, and a note names it. Fails (kUnsupported) only if
// libwebp refuses a picture. Call this in the sandbox if the pictures are untrusted.
Expected<BakedTexture> bake(const TriangleMesh& mesh, Texturing texturing,
                            std::span<const DisplayFace> display);

}  // namespace vitrine::inline codec
