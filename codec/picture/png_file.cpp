// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/write_picture.h"

#include <png.h>

#include <memory>
#include <string>

namespace vitrine::inline codec {

Expected<std::vector<std::uint8_t>> write_png(const Picture& picture) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = picture.width;
  png.height = picture.height;
  png.format = PNG_FORMAT_RGBA;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&png, png_image_free);
  std::vector<std::uint8_t> file(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = file.size();
  if (png_image_write_to_memory(&png, file.data(), &size, 0, picture.pixels.data(), 0, nullptr) ==
      0) {
    return fail(ErrorCode::kUnsupported,
                std::string("the picture cannot be written as PNG: ") + png.message);
  }
  file.resize(size);
  return file;
}

}  // namespace vitrine::inline codec
