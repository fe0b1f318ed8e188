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
constexpr std::uint64_t kFlatWebpPixels = 1 << 24;  // allowed for a WebP file of any size

// An image format that is not supported. A file of this format has the text `magic` at byte offset
// `at`. `type` is the format's media type.
struct Format {
  std::string_view type;
  std::size_t at;
  std::string_view magic;
};
constexpr std::array<Format, 17> kOthers{{{"image/ktx2", 0, "\xABKTX 20"},
                                          {"image/ktx", 0, "\xABKTX 11"},
                                          {"image/avif", 4, "ftypavif"},
                                          {"image/heic", 4, "ftyphei"},
                                          {"image/jp2", 4, "jP  "},
                                          {"image/jxl", 0, "\xFF\x0A"},
                                          {"image/jxl", 4, "JXL "},
                                          {"image/vnd.adobe.photoshop", 0, "8BPS"},
                                          {"image/x-exr", 0, "\x76\x2F\x31\x01"},
                                          {"image/vnd.radiance", 0, "#?RADIANCE"},
                                          {"image/tiff", 0, {"II*\0", 4}},
                                          {"image/tiff", 0, {"MM\0*", 4}},
                                          // the signature of BigTIFF
                                          {"image/tiff", 0, {"II+\0\b\0", 6}},
                                          {"image/tiff", 0, {"MM\0+\0\b", 6}},
                                          {"image/gif", 0, "GIF8"},
                                          {"image/bmp", 0, "BM"},
                                          {"image/vnd-ms.dds", 0, "DDS "}}};

// Whether the bytes are a TGA picture. The format has no signature at its start. Newer files have
// one at their end; others are recognised by the fields of their header.
bool is_tga(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kEnd = "TRUEVISION-XFILE";
  constexpr std::size_t kFooter = 18, kHeader = 18;
  if (bytes.size() < kHeader) return false;
  if (std::ranges::equal(bytes.last(kFooter).first(kEnd.size()), kEnd)) return true;
  const std::uint8_t type = bytes[2], depth = bytes[16];
  const bool has_type = (type >= 1 && type <= 3) || (type >= 9 && type <= 11);
  const bool has_depth = depth == 8 || depth == 16 || depth == 24 || depth == 32;
  const bool has_size = (bytes[12] | bytes[13]) != 0 && (bytes[14] | bytes[15]) != 0;
  return bytes[1] <= 1 && has_type && has_depth && has_size && (bytes[17] & 0xC0) == 0;
}

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

Unexpected unread(Bytes bytes) {
  const auto* known = std::ranges::find_if(
      kOthers, [&](const Format& format) { return has_at(bytes, format.at, format.magic); });
  const std::string_view type = known != kOthers.end() ? known->type
                                : is_tga(bytes)        ? "image/x-tga"
                                                       : "";
  if (!type.empty()) {
    return fail(ErrorCode::kUnsupported,
                "is " + std::string(type) + "; convert it to PNG, JPEG or WebP");
  }
  return fail(ErrorCode::kUnsupported, "is not PNG, JPEG or WebP; convert it to one of them");
}

// Returns an error. `what` describes the file, such as "a damaged PNG".
Unexpected damaged(std::string_view what) {
  return fail(ErrorCode::kBadInput, "is " + std::string(what) + "; export it again");
}

Unexpected too_many_pixels() {
  return fail(ErrorCode::kLimit, "has too many pixels; make it smaller");
}

// Returns a picture whose pixels are not set yet, and subtracts their number from `pixels_left`.
// `credible_pixels` is the largest number of pixels that the file's bytes can encode.
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

// Converts pixels of a JPEG from CMYK to RGB with full opacity, without a colour profile. Such
// JPEGs store inverted values: 0 is full ink.
void cmyk_to_rgb(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const std::uint32_t black = pixels[i + 3];
    for (std::size_t k = i; k < i + 3; ++k)
      pixels[k] = static_cast<std::uint8_t>((pixels[k] * black + 127) / 255);
    pixels[i + 3] = 255;
  }
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
  const bool is_cmyk = space == TJCS_CMYK || space == TJCS_YCCK;
  if (tjDecompress2(jpeg.get(), bytes.data(), bytes.size(), picture->pixels.data(), width, 0,
                    height, is_cmyk ? TJPF_CMYK : TJPF_RGBA,
                    TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0) {
    return damaged("a damaged JPEG, or one whose colours are not RGB or CMYK");
  }
  if (is_cmyk) cmyk_to_rgb(picture->pixels);
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

bool is_webp(Bytes bytes) {
  return has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP");
}

Expected<void> check_picture_format(Bytes bytes) {
  if (is_png(bytes) || is_jpeg(bytes) || is_webp(bytes)) return {};
  return unread(bytes);
}

Expected<Picture> decode_picture(Bytes bytes, std::uint64_t most_pixels) {
  return decode_picture_within(most_pixels, bytes);
}

Expected<Picture> decode_picture_within(std::uint64_t& pixels_left, Bytes bytes) {
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  if (pixels_left == 0) return too_many_pixels();  // saves the slow search for the picture's size
  if (is_png(bytes)) return decode_png(bytes, pixels_left);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, pixels_left);
  return decode_webp(bytes, pixels_left);
}

}  // namespace vitrine::inline codec
