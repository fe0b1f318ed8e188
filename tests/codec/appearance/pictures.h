// SPDX-License-Identifier: Apache-2.0
// Pictures for tests that compare pictures.
#pragma once

#include <random>

#include "codec/picture/picture.h"

namespace vitrine::test {

// Returns an opaque picture. The red, green and blue of each pixel are `grey(x, y)`.
template <class Grey>
Picture grey_picture(std::uint32_t width, std::uint32_t height, Grey grey) {
  Picture picture{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto shade = static_cast<std::uint8_t>(grey(x, y));
      picture.pixels.insert(picture.pixels.end(), {shade, shade, shade, 255});
    }
  }
  return picture;
}

inline Picture random_picture(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  std::mt19937 random(seed);
  return grey_picture(width, height, [&](auto, auto) { return random() % 256; });
}

}  // namespace vitrine::test
