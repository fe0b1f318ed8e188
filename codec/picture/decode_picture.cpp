// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/decode_picture.h"

#include <turbojpeg.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "codec/picture/png_reader.h"

namespace vitrine::inline codec {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMostPixelsPerByte = 1024;
constexpr std::uint64_t kFlatWebpPixels = 1 << 24;  // allowed in a WebP of any number of bytes

// An image format that is not supported. It is recognised by the text `magic` at byte offset `at`;
// `type` is its media type.
struct Format {
  std::string_view type;
  std::size_t at;
  std::string_view magic;
};
constexpr std::array<Format, 7> kOthers{{{"image/ktx2", 0, "\xABKTX 20"},
                                         {"image/avif", 4, "ftypavif"},
                                         {"image/tiff", 0, {"II*\0", 4}},
                                         {"image/tiff", 0, {"MM\0*", 4}},
                                         {"image/gif", 0, "GIF8"},
                                         {"image/bmp", 0, "BM"},
                                         {"image/vnd-ms.dds", 0, "DDS "}}};

bool has_at(Bytes bytes, std::size_t at, std::string_view magic) {
  return bytes.size() >= at + magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

bool is_png(Bytes bytes) {
  return has_at(bytes, 0, "\x89PNG");
}
bool is_jpeg(Bytes bytes) {
  return has_at(bytes, 0, "\xFF\xD8\xFF");
}
bool is_webp(Bytes bytes) {
  return has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP");
}

Unexpected unread(Bytes bytes) {
  for (const auto& [type, at, magic] : kOthers) {
    if (!has_at(bytes, at, magic)) continue;
    return fail(ErrorCode::kUnsupported,
                "is " + std::string(type) + "; convert it to PNG, JPEG or WebP");
  }
  return fail(ErrorCode::kUnsupported, "is not PNG, JPEG or WebP; convert it to one of them");
}

// `what` describes the file, such as "a damaged PNG".
Unexpected damaged(std::string_view what) {
  return fail(ErrorCode::kBadInput, "is " + std::string(what) + "; export it again");
}

Unexpected too_many_pixels() {
  return fail(ErrorCode::kLimit, "has too many pixels; make it smaller");
}

// Returns a picture without contents. `credible_pixels` is the largest number of pixels that the
// bytes of the file can hold. Subtracts the picture's pixels from `pixels_left`.
Expected<Picture> blank(std::uint64_t width, std::uint64_t height, std::uint64_t credible_pixels,
                        std::uint64_t& pixels_left) {
  if (width == 0 || height == 0 || width > 1 << 24 || height > 1 << 24 ||
      width * height > credible_pixels) {
    return damaged("damaged");
  }
  if (width * height > pixels_left) return too_many_pixels();
  pixels_left -= width * height;
  Picture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  picture.pixels.resize(4 * width * height);
  return picture;
}

Expected<Picture> decode_png(Bytes bytes, std::uint64_t& pixels_left) {
  PngReader png(bytes);
  if (!png.read_header()) return damaged("a damaged PNG");
  auto picture = blank(png.width(), png.height(), kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  if (!png.read_pixels(picture->pixels.data())) return damaged("a damaged PNG");
  return picture;
}

Expected<Picture> decode_jpeg(Bytes bytes, std::uint64_t& pixels_left) {
  const std::unique_ptr<void, decltype(&tjDestroy)> jpeg(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, sampling = 0, space = 0;
  if (!jpeg || tjDecompressHeader3(jpeg.get(), bytes.data(), bytes.size(), &width, &height,
                                   &sampling, &space) != 0) {
    return damaged("a damaged JPEG");
  }
  auto picture = blank(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                       kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  if (tjDecompress2(jpeg.get(), bytes.data(), bytes.size(), picture->pixels.data(), width, 0,
                    height, TJPF_RGBA, TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0) {
    return damaged("a damaged JPEG, or one whose colours are not RGB");
  }
  return picture;
}

Expected<Picture> decode_webp(Bytes bytes, std::uint64_t& pixels_left) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
    return damaged("a damaged WebP");
  }
  if (features.has_animation != 0) {
    return fail(ErrorCode::kUnsupported, "is an animated WebP; convert it to a still picture");
  }
  auto picture =
      blank(static_cast<std::uint64_t>(features.width), static_cast<std::uint64_t>(features.height),
            std::max(kFlatWebpPixels, kMostPixelsPerByte * bytes.size()), pixels_left);
  if (!picture) return picture;
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), picture->pixels.data(), picture->pixels.size(),
                         4 * features.width) == nullptr) {
    return damaged("a damaged WebP");
  }
  return picture;
}

}  // namespace

Expected<void> check_picture_format(Bytes bytes) {
  if (is_png(bytes) || is_jpeg(bytes) || is_webp(bytes)) return {};
  return unread(bytes);
}

Expected<Picture> decode_picture(Bytes bytes, std::uint64_t most_pixels) {
  return decode_picture_within(most_pixels, bytes);
}

Expected<Picture> decode_picture_within(std::uint64_t& pixels_left, Bytes bytes) {
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  if (pixels_left == 0) return too_many_pixels();  // without a search for the size
  if (is_png(bytes)) return decode_png(bytes, pixels_left);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, pixels_left);
  return decode_webp(bytes, pixels_left);
}

}  // namespace vitrine::inline codec
