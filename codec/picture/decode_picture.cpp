// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/decode_picture.h"

#include <turbojpeg.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "codec/files/picture_formats.h"
#include "codec/picture/bitmap_file.h"
#include "codec/picture/blank_picture.h"
#include "codec/picture/png_reader.h"
#include "codec/picture/tiff_file.h"

namespace vitrine::inline codec {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kFlatWebpPixels = 1 << 24;  // a WebP of any file size may have this many

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

bool has_signature_of(Bytes bytes, const PictureFormat& format) {
  return std::ranges::any_of(format.signatures, [&](const PictureSignature& signature) {
    return !signature.magic.empty() && has_at(bytes, signature.at, signature.magic);
  });
}

// Returns the media type of a picture that is not supported, or an empty string if it is unknown.
std::string_view other_type(Bytes bytes) {
  const auto* known = std::ranges::find_if(
      kOtherPictures, [&](const PictureFormat& format) { return has_signature_of(bytes, format); });
  return known == kOtherPictures.end() ? std::string_view() : known->type;
}

Expected<Picture> decode_png(Bytes bytes, std::uint64_t& pixels_left) {
  PngReader png(bytes);
  if (!png.read_header()) return damaged_picture("a damaged PNG");
  auto picture =
      blank_picture(png.width(), png.height(), kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  if (!png.read_pixels(picture->pixels.data())) return damaged_picture("a damaged PNG");
  return picture;
}

// Whether a JPEG has the APP14 segment of Adobe's programs ([JPEG] B.2.4.6).
bool has_adobe_segment(Bytes bytes) {
  constexpr std::uint8_t kApp14 = 0xEE, kStartOfScan = 0xDA;
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == 0xFF && bytes[at + 1] != kStartOfScan) {
    if (bytes[at + 1] == kApp14 && has_at(bytes, at + 4, "Adobe")) return true;
    at += bytes[at + 1] == 0xFF ? 1u : 2u + bytes[at + 2] * 256u + bytes[at + 3];
  }
  return false;
}

// Converts pixels of a JPEG from CMYK to RGB with full opacity, without a colour profile. 0 is full
// ink, as in the JPEGs of Adobe's programs.
void cmyk_to_rgb(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const std::uint32_t black = pixels[i + 3];
    for (std::size_t k = i; k < i + 3; ++k)
      pixels[k] = static_cast<std::uint8_t>((pixels[k] * black + 127) / 255);
    pixels[i + 3] = 255;
  }
}

void invert(std::vector<std::uint8_t>& pixels) {
  for (std::uint8_t& value : pixels)
    value = static_cast<std::uint8_t>(255 - value);
}

Expected<Picture> decode_jpeg(Bytes bytes, std::uint64_t& pixels_left) {
  const std::unique_ptr<void, decltype(&tjDestroy)> jpeg(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, sampling = 0, space = 0;
  if (!jpeg || tjDecompressHeader3(jpeg.get(), bytes.data(), bytes.size(), &width, &height,
                                   &sampling, &space) != 0) {
    return damaged_picture("a damaged JPEG");
  }
  auto picture =
      blank_picture(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                    kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  const bool is_cmyk = space == TJCS_CMYK || space == TJCS_YCCK;
  if (tjDecompress2(jpeg.get(), bytes.data(), bytes.size(), picture->pixels.data(), width, 0,
                    height, is_cmyk ? TJPF_CMYK : TJPF_RGBA,
                    TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0) {
    return damaged_picture("a damaged JPEG, or one whose colours are not RGB or CMYK");
  }
  if (is_cmyk && !has_adobe_segment(bytes)) invert(picture->pixels);  // 255 is full ink
  if (is_cmyk) cmyk_to_rgb(picture->pixels);
  return picture;
}

Expected<Picture> decode_webp(Bytes bytes, std::uint64_t& pixels_left) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
    return damaged_picture("a damaged WebP");
  }
  if (features.has_animation != 0) {
    return fail(ErrorCode::kUnsupported, "is an animated WebP; convert it to a still picture");
  }
  auto picture = blank_picture(
      static_cast<std::uint64_t>(features.width), static_cast<std::uint64_t>(features.height),
      std::max(kFlatWebpPixels, kMostPixelsPerByte * bytes.size()), pixels_left);
  if (!picture) return picture;
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), picture->pixels.data(), picture->pixels.size(),
                         4 * features.width) == nullptr) {
    return damaged_picture("a damaged WebP");
  }
  return picture;
}

}  // namespace

bool is_webp(Bytes bytes) {
  return has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP");
}

bool is_carried_format(Bytes bytes) {
  return is_png(bytes) || is_jpeg(bytes) || is_webp(bytes);
}

Expected<void> check_picture_format(Bytes bytes) {
  if (is_carried_format(bytes) || is_tiff(bytes) || is_bmp(bytes)) return {};
  const std::string_view type = other_type(bytes);
  if (!type.empty()) {
    return fail(ErrorCode::kUnsupported,
                "is " + std::string(type) + "; convert it to PNG, JPEG or WebP");
  }
  if (is_tga(bytes)) return {};
  return fail(ErrorCode::kUnsupported,
              "is not PNG, JPEG, WebP, TIFF, BMP or TGA; convert it to one of them");
}

Expected<Picture> decode_picture(Bytes bytes, std::uint64_t most_pixels) {
  return decode_picture_within(most_pixels, bytes);
}

Expected<Picture> decode_picture_within(std::uint64_t& pixels_left, Bytes bytes) {
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  // If no pixels are left, skips the slow search for the picture's size.
  if (pixels_left == 0) return fail(ErrorCode::kLimit, "has too many pixels; make it smaller");
  if (is_png(bytes)) return decode_png(bytes, pixels_left);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, pixels_left);
  if (is_webp(bytes)) return decode_webp(bytes, pixels_left);
  if (is_tiff(bytes)) return read_tiff(bytes, pixels_left);
  return read_bitmap(bytes, pixels_left);
}

}  // namespace vitrine::inline codec
