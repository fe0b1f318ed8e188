// SPDX-License-Identifier: Apache-2.0
// Decodes PNG, JPEG and WebP pictures.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Fails (kUnsupported) unless the bytes begin like PNG, JPEG or WebP.
Expected<void> check_picture_format(std::span<const std::uint8_t> bytes);

// Decodes a picture, recognised by its content. The size in its header is checked before memory is
// allocated: at most `most_pixels` pixels, and at most 1024 pixels per byte. A WebP of one colour
// has a few bytes at any size, so one with up to 4096 x 4096 pixels needs no more bytes. The
// libraries are not safe on hostile bytes, so call this in the sandbox.
//
// Fails (kBadInput, kUnsupported, kLimit) with a fault and a next step, such as "is image/gif;
// convert it to PNG, JPEG or WebP". The caller adds the picture's name.
Expected<Picture> decode_picture(std::span<const std::uint8_t> bytes, std::uint64_t most_pixels);

// Decodes a picture of at most `pixels_left` pixels and subtracts its pixels from `pixels_left`,
// even if the picture turns out to be damaged after memory was allocated. So a file with many
// damaged pictures cannot cause more work than one with intact pictures. Fails as decode_picture().
Expected<Picture> decode_picture_within(std::uint64_t& pixels_left,
                                        std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
