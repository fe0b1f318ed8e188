// SPDX-License-Identifier: Apache-2.0
// Decodes PNG [PNG], JPEG [JPEG], WebP [WebP], TIFF [TIFF], BMP and TGA pictures.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Fails (kUnsupported) unless the bytes begin like a file of one of these formats.
Expected<void> check_picture_format(std::span<const std::uint8_t> bytes);

// Whether the bytes begin like a PNG, JPEG or WebP file. A .pmesh file keeps the bytes of such
// pictures.
bool is_carried_format(std::span<const std::uint8_t> bytes);

// Whether the bytes begin like a WebP file.
bool is_webp(std::span<const std::uint8_t> bytes);

// Decodes a picture and recognises the format by its content. Before it allocates memory, checks
// the size in the header: at most `most_pixels` pixels, and at most 1024 pixels per byte. A WebP
// may always have up to 4096 x 4096 pixels, because a WebP of one colour takes only a few bytes at
// any size. The image libraries are not safe on hostile bytes: call this in the sandbox.
//
// Fails (kBadInput, kUnsupported, kLimit) with a fault and a next step, such as "is image/gif;
// convert it to PNG, JPEG or WebP". The caller adds the picture's name.
Expected<Picture> decode_picture(std::span<const std::uint8_t> bytes, std::uint64_t most_pixels);

// Decodes a picture of at most `pixels_left` pixels. Subtracts the picture's pixels from
// `pixels_left`, even if the picture proves to be damaged after memory was allocated. A file with
// many damaged pictures therefore causes no more work than one with intact pictures. Fails like
// decode_picture().
Expected<Picture> decode_picture_within(std::uint64_t& pixels_left,
                                        std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
