// SPDX-License-Identifier: Apache-2.0
// A picture as an array of pixels in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

struct Picture {
  std::uint32_t width = 0, height = 0;
  // Rows from top to bottom. A pixel has four bytes: red, green and blue in sRGB, and opacity.
  std::vector<std::uint8_t> pixels;

  Colour at(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* pixel = &pixels[4 * (std::size_t{y} * width + x)];
    return {pixel[0], pixel[1], pixel[2]};
  }
};

}  // namespace vitrine::inline codec
