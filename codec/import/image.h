// SPDX-License-Identifier: Apache-2.0
// Pictures that colour a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/import/linear_colour.h"

namespace vitrine {

struct Image {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // sRGB and alpha, four bytes each, rows from the top

  Colour at(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* pixel = &pixels[4 * (std::size_t{y} * width + x)];
    return {pixel[0], pixel[1], pixel[2]};
  }
};

inline constexpr std::uint64_t kMostPixels = 1u << 28;  // of all pictures of a model together

// Decodes a PNG or JPEG, told apart by content. Its size is checked before anything is allocated:
// at most `most_pixels`, and at most 1024 for each byte. The libraries are not proof against every
// byte: this belongs into the sandbox. Fails (kBadInput, kUnsupported, kLimit) with the fault
// and any next step, as in "is image/webp; convert it to PNG or JPEG": the caller names the
// picture.
Expected<Image> decode_image(std::span<const std::uint8_t> bytes, std::uint64_t most_pixels);

// What a coordinate outside of [0, 1) means.
enum class Wrap { kRepeat, kMirror, kClamp };

// The colour at (u, v), v from the top: bilinear between the centres of pixels, in linear light.
// Coordinates that are not finite are taken as 0. `image` has at least one pixel.
LinearColour sample(const Image& image, double u, double v, Wrap wrap_u, Wrap wrap_v);

}  // namespace vitrine
