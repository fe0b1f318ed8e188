// SPDX-License-Identifier: Apache-2.0
// Reads the first page of a TIFF file [TIFF].
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Whether the bytes begin like a TIFF or BigTIFF file.
bool is_tiff(std::span<const std::uint8_t> bytes);

// Reads the pixels as RGB with straight opacity, in the orientation that the file states. The
// orientations that exchange rows and columns (5 to 8) are only mirrored. Extra channels that are
// not declared as opacity are ignored. Values of 16 bits become 8 bits; CMYK becomes RGB without a
// colour profile. Subtracts the pixels from `pixels_left`. Fails (kBadInput, kUnsupported, kLimit)
// like decode_picture().
Expected<Picture> read_tiff(std::span<const std::uint8_t> bytes, std::uint64_t& pixels_left);

}  // namespace vitrine::inline codec
