// SPDX-License-Identifier: Apache-2.0
// Decodes pictures and samples their colours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/repair/linear_colour.h"

namespace vitrine::inline codec {

struct Image {
  std::uint32_t width = 0, height = 0;
  // Rows from top to bottom, with four bytes per pixel: sRGB and alpha.
  std::vector<std::uint8_t> pixels;

  Colour at(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* pixel = &pixels[4 * (std::size_t{y} * width + x)];
    return {pixel[0], pixel[1], pixel[2]};
  }
};

// Maximum number of pixels in all pictures of a model together.
inline constexpr std::uint64_t kMostPixels = 1u << 28;

// Decodes a PNG or JPEG picture, recognised by its content. The size is checked before memory is
// allocated: at most `most_pixels` pixels, and at most 1024 pixels per byte. The libraries are not
// safe on hostile bytes, so call this in the sandbox.
//
// Fails (kBadInput, kUnsupported, kLimit) with a fault and a next step, such as "is image/webp;
// convert it to PNG or JPEG". The caller adds the picture's name.
Expected<Image> decode_image(std::span<const std::uint8_t> bytes, std::uint64_t most_pixels);

// How to treat a coordinate outside [0, 1).
enum class Wrap { kRepeat, kMirror, kClamp };

// Returns the colour at (u, v), where v = 0 is the top. Interpolates bilinearly between pixel
// centres, in linear light. Coordinates that are not finite are treated as 0. `image` must have at
// least one pixel.
LinearColour sample(const Image& image, double u, double v, Wrap wrap_u, Wrap wrap_v);

}  // namespace vitrine::inline codec
