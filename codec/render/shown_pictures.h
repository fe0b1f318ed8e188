// SPDX-License-Identifier: Apache-2.0
// Decodes the pictures of a mesh that its renderer shows.
#pragma once

#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/texturing.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Returns the pictures of `texturing` in the same order, as Textures takes them. Only the pictures
// of maps of base colours and normals are decoded; the others have no pixels. Call this in the
// sandbox if the bytes are untrusted.
//
// Fails as decode_picture() does, with the picture's name, and (kLimit) if the decoded pictures
// have more than `most_pixels` pixels together.
Expected<std::vector<Picture>> decode_shown_pictures(const Texturing& texturing,
                                                     std::uint64_t most_pixels);

}  // namespace vitrine::inline codec
