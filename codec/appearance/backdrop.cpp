// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/backdrop.h"

namespace vitrine::inline codec {

void lay_over_grey(Picture& picture) {
  constexpr unsigned kGrey = 128, kOpaque = 255;
  for (std::size_t at = 0; at < picture.pixels.size(); at += 4) {
    const unsigned opacity = picture.pixels[at + 3];
    for (std::size_t c = at; c < at + 3; ++c) {
      const unsigned sum = opacity * picture.pixels[c] + (kOpaque - opacity) * kGrey;
      picture.pixels[c] = static_cast<std::uint8_t>((sum + kOpaque / 2) / kOpaque);
    }
  }
}

}  // namespace vitrine::inline codec
