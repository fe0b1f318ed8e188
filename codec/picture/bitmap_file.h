// SPDX-License-Identifier: Apache-2.0
// Reads BMP and TGA pictures.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Whether the bytes begin like a BMP file.
bool is_bmp(std::span<const std::uint8_t> bytes);

// Whether the bytes are a TGA file. The format has no signature at its start. Newer files have a
// signature at their end; other files are recognised by the fields of their header. Test for other
// formats first, because files of other formats may look like TGA.
bool is_tga(std::span<const std::uint8_t> bytes);

// Reads a BMP or TGA file. Subtracts its pixels from `pixels_left`. Fails (kBadInput, kUnsupported,
// kLimit) like decode_picture().
Expected<Picture> read_bitmap(std::span<const std::uint8_t> bytes, std::uint64_t& pixels_left);

}  // namespace vitrine::inline codec
