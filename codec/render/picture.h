// SPDX-License-Identifier: Apache-2.0
// A picture as an array of pixels in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrine::inline codec {

struct Picture {
  std::uint32_t width = 0, height = 0;
  // Rows from top to bottom, with four bytes per pixel: sRGB and opacity.
  std::vector<std::uint8_t> pixels;
};

}  // namespace vitrine::inline codec
