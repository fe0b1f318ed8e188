// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/blank_picture.h"

#include <string>

namespace vitrine::inline codec {

Unexpected damaged_picture(std::string_view what) {
  return fail(ErrorCode::kBadInput, "is " + std::string(what) + "; export it again");
}

Expected<Picture> blank_picture(std::uint64_t width, std::uint64_t height,
                                std::uint64_t credible_pixels, std::uint64_t& pixels_left) {
  if (width == 0 || height == 0 || width > 1 << 24 || height > 1 << 24 ||
      width * height > credible_pixels) {
    return damaged_picture("damaged");
  }
  if (width * height > pixels_left)
    return fail(ErrorCode::kLimit, "has too many pixels; make it smaller");
  pixels_left -= width * height;
  Picture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  picture.pixels.resize(4 * width * height);
  return picture;
}

}  // namespace vitrine::inline codec
