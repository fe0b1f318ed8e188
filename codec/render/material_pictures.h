// SPDX-License-Identifier: Apache-2.0
// Decodes the pictures of a mesh's materials.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// The maps that the renderer shows.
inline constexpr std::array<MapOfMaterial, 2> kShownMaps = {&Material::base_colour_map,
                                                            &Material::normal_map};

// Returns the pictures of `texturing` in the same order, as the constructor of Textures requires
// them. Decodes only the pictures that one of `maps` uses in some material; all other pictures have
// no pixels. Call this in the sandbox if the bytes are untrusted.
//
// Fails as decode_picture() does, with the picture's name, and (kLimit) if the decoded pictures
// have more than `most_pixels` pixels together.
Expected<std::vector<Picture>> decode_pictures(const Texturing& texturing,
                                               std::span<const MapOfMaterial> maps,
                                               std::uint64_t most_pixels);

}  // namespace vitrine::inline codec
