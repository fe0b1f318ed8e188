// SPDX-License-Identifier: Apache-2.0
// Converts the texture of a model to the form that files of other formats have: one material,
// texture coordinates per face corner, and pictures that every viewer reads.
#pragma once

#include <bitset>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/texturing.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// Returns the bytes of picture number `i` of a texture, after checking their SHA-256. The bytes
// stay valid until the next call.
using PictureReader = std::function<Expected<std::span<const std::uint8_t>>(std::size_t i)>;

using PictureRoles = std::bitset<kPictureRoles>;  // bit i is set if PictureRole i is included

// Returns the numbers of the pictures to export, one for each role of `roles` that the texture has.
// The list is empty if the texture has none of these roles.
//
// If `most_side` is set, chooses the largest picture with at most that many pixels per side, or the
// smallest picture if all are larger. A `most_side` of 0 gives an empty list. If `most_side` is not
// set, chooses the smallest picture with at least 16 pixels per face of the exported mesh, which
// has `faces` faces. At full resolution, chooses the largest picture.
std::vector<std::size_t> pictures_to_export(const Manifest& manifest, std::uint64_t faces,
                                            std::optional<std::uint32_t> most_side,
                                            PictureRoles roles = PictureRoles().set());

// Returns the texturing of the mesh refiner.display_mesh(), with the pictures `numbers`. Converts
// pictures to JPEG, or to PNG for base colours of a surface that is not opaque. Returns an empty
// Texturing if `numbers` is empty. Fails with the error of `read`, or (kBadInput) if a picture
// cannot be decoded. libwebp decodes the pictures and is not safe on hostile bytes.
Expected<Texturing> texturing_to_export(const Refiner& refiner,
                                        std::span<const std::size_t> numbers,
                                        const PictureReader& read);

}  // namespace vitrine::inline codec
