// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/bitmap_file.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "codec/picture/blank_picture.h"

// Leaves out the other decoders of stb_image. They are not needed, and their code would read
// untrusted bytes.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace vitrine::inline codec {
namespace {

// A file in memory, as stb_image reads it. If stb_image reads beyond the end, it uses zeros and
// reports no error. `is_short` records that this happened.
struct BitmapBytes {
  std::span<const std::uint8_t> left;
  bool is_short = false;

  static int read(void* self, char* out, int size) {
    constexpr int kBufferedAhead = 128;  // stb_image fills its buffer by reads of this size
    auto& [left, is_short] = *static_cast<BitmapBytes*>(self);
    const std::size_t given = std::min(static_cast<std::size_t>(std::max(size, 0)), left.size());
    const bool is_partial = static_cast<int>(given) < size && size != kBufferedAhead;
    is_short = is_short || given == 0 || is_partial;
    std::ranges::copy(left.first(given), out);
    left = left.subspan(given);
    return static_cast<int>(given);
  }
  static void skip(void* self, int size) {
    auto& left = static_cast<BitmapBytes*>(self)->left;
    left = left.subspan(std::min(static_cast<std::size_t>(std::max(size, 0)), left.size()));
  }
  static int eof(void* self) { return static_cast<BitmapBytes*>(self)->left.empty() ? 1 : 0; }
};

constexpr stbi_io_callbacks kBitmapCallbacks{BitmapBytes::read, BitmapBytes::skip,
                                             BitmapBytes::eof};

}  // namespace

bool is_bmp(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 2 && bytes[0] == 'B' && bytes[1] == 'M';
}

bool is_tga(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kEnd = "TRUEVISION-XFILE";
  constexpr std::size_t kFooter = 18, kHeader = 18;
  if (bytes.size() < kHeader) return false;
  if (std::ranges::equal(bytes.last(kFooter).first(kEnd.size()), kEnd)) return true;
  const std::uint8_t type = bytes[2], depth = bytes[16];
  const bool has_type = (type >= 1 && type <= 3) || (type >= 9 && type <= 11);
  const bool has_depth = depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32;
  const bool has_size = (bytes[12] | bytes[13]) != 0 && (bytes[14] | bytes[15]) != 0;
  return bytes[1] <= 1 && has_type && has_depth && has_size && (bytes[17] & 0xC0) == 0;
}

Expected<Picture> read_bitmap(std::span<const std::uint8_t> bytes, std::uint64_t& pixels_left) {
  const std::string kind = is_bmp(bytes) ? "BMP" : "TGA";
  int width = 0, height = 0, channels = 0;
  BitmapBytes header{bytes}, source{bytes};
  if (stbi_info_from_callbacks(&kBitmapCallbacks, &header, &width, &height, &channels) == 0) {
    return fail(ErrorCode::kUnsupported,
                "is a damaged or unusual " + kind + "; convert it to PNG, JPEG or WebP");
  }
  auto picture =
      blank_picture(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                    kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_callbacks(&kBitmapCallbacks, &source, &width, &height, &channels, 4),
      stbi_image_free);
  const bool has_stated_size = static_cast<std::uint32_t>(width) == picture->width &&
                               static_cast<std::uint32_t>(height) == picture->height;
  if (!pixels || source.is_short || !has_stated_size) return damaged_picture("a damaged " + kind);
  std::memcpy(picture->pixels.data(), pixels.get(), picture->pixels.size());
  return picture;
}

}  // namespace vitrine::inline codec
