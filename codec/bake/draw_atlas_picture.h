// SPDX-License-Identifier: Apache-2.0
// Draws the faces of a mesh into a picture of the display atlas.
#pragma once

#include <span>

#include "codec/bake/atlas_picture.h"
#include "codec/bake/bake.h"
#include "codec/render/textures.h"

namespace vitrine::inline codec {

// Returns the picture for one role, such as base colours, with `side` texels per side. Inside the
// faces, the picture differs as little as possible from the source.
AtlasPicture draw_atlas_picture(PictureRole role, std::uint32_t side, const TriangleMesh& mesh,
                                const Textures& textures, std::span<const DisplayFace> display);

}  // namespace vitrine::inline codec
