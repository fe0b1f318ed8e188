// SPDX-License-Identifier: Apache-2.0
// Allocates pictures for decoders, within a budget of pixels, and creates the decoders' errors.
#pragma once

#include <cstdint>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Largest credible number of pixels per byte of a picture file.
inline constexpr std::uint64_t kMostPixelsPerByte = 1024;

// Returns an error. `what` describes the file, such as "a damaged PNG".
Unexpected damaged_picture(std::string_view what);

// Returns a picture whose pixels are not set yet, and subtracts their number from `pixels_left`.
// `credible_pixels` is the largest number of pixels that the file's bytes can encode. Fails
// (kBadInput, kLimit) before it allocates memory.
Expected<Picture> blank_picture(std::uint64_t width, std::uint64_t height,
                                std::uint64_t credible_pixels, std::uint64_t& pixels_left);

}  // namespace vitrine::inline codec
