// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/tiff_file.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <string_view>

#include "codec/picture/blank_picture.h"

namespace vitrine::inline codec {
namespace {

// Largest block of memory that libtiff may allocate for a part of a picture.
constexpr tmsize_t kLargestBlock = 1 << 28;

// A TIFF file in memory, as libtiff reads it.
struct TiffBytes {
  std::span<const std::uint8_t> bytes;
  std::uint64_t at = 0;

  static tmsize_t read(thandle_t self, void* out, tmsize_t size) {
    auto& [bytes, at] = *static_cast<TiffBytes*>(self);
    if (size < 0 || at >= bytes.size()) return 0;
    const auto given = std::min<std::uint64_t>(static_cast<std::uint64_t>(size), bytes.size() - at);
    std::memcpy(out, &bytes[at], given);
    at += given;
    return static_cast<tmsize_t>(given);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
  static toff_t seek(thandle_t self, toff_t offset, int whence) {
    auto& [bytes, at] = *static_cast<TiffBytes*>(self);
    at = offset + (whence == SEEK_CUR ? at : whence == SEEK_END ? bytes.size() : 0);
    return at;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t self) { return static_cast<TiffBytes*>(self)->bytes.size(); }
};

// Replaces the handlers of libtiff that print messages.
int keep_quiet(TIFF*, void*, const char*, const char*, va_list) {
  return 1;
}

using OpenTiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

OpenTiff open_tiff(TiffBytes& source) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kLargestBlock);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_quiet, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_quiet, nullptr);
  return {TIFFClientOpenExt("", "rm", &source, TiffBytes::read, TiffBytes::write, TiffBytes::seek,
                            TiffBytes::close, TiffBytes::size, nullptr, nullptr, options.get()),
          TIFFClose};
}

// Whether the first extra channel is opacity. Programs write other channels, such as masks, as
// unspecified, but libtiff treats them as opacity too.
bool has_opacity(TIFF* tiff) {
  std::uint16_t count = 0, *kinds = nullptr;
  return TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) == 1 && count > 0 &&
         kinds[0] != EXTRASAMPLE_UNSPECIFIED;
}

void make_opaque(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 3; i < pixels.size(); i += 4)
    pixels[i] = 255;
}

// Divides the colours by the opacity, because libtiff has multiplied the colours by the opacity.
void straighten_opacity(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const std::uint32_t opacity = pixels[i + 3];
    if (opacity == 0 || opacity == 255) continue;
    for (std::size_t k = i; k < i + 3; ++k)
      pixels[k] = static_cast<std::uint8_t>(
          std::min<std::uint32_t>(255, (pixels[k] * 255u + opacity / 2) / opacity));
  }
}

// Sets the white point with which libtiff converts CIELab to sRGB to D65, so that greys stay grey.
// With libtiff's default, D50, greys would become brown.
void adapt_white(TIFF* tiff) {
  std::uint16_t kind = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &kind);
  std::array<float, 2> d65{0.3127F, 0.3290F};
  if (kind == PHOTOMETRIC_CIELAB || kind == PHOTOMETRIC_ICCLAB)
    TIFFSetField(tiff, TIFFTAG_WHITEPOINT, d65.data());
}

}  // namespace

bool is_tiff(std::span<const std::uint8_t> bytes) {
  using std::string_view_literals::operator""sv;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // the last two are the signatures of BigTIFF
  return std::ranges::any_of(std::array{"II*\0"sv, "MM\0*"sv, "II+\0\b\0"sv, "MM\0+\0\b"sv},
                             [&](std::string_view magic) { return text.starts_with(magic); });
}

Expected<Picture> read_tiff(std::span<const std::uint8_t> bytes, std::uint64_t& pixels_left) {
  TiffBytes source{bytes};
  const OpenTiff tiff = open_tiff(source);
  std::uint32_t width = 0, height = 0;
  if (!tiff || TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width) != 1 ||
      TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height) != 1)
    return damaged_picture("a damaged TIFF");
  auto picture = blank_picture(width, height, kMostPixelsPerByte * bytes.size(), pixels_left);
  if (!picture) return picture;
  std::array<char, 1024> fault{};  // libtiff demands this size
  if (TIFFRGBAImageOK(tiff.get(), fault.data()) == 0) {
    return fail(ErrorCode::kUnsupported,
                "is a TIFF with an unusual kind of pixels or compression; convert it to PNG, JPEG "
                "or WebP");
  }
  adapt_white(tiff.get());
  // libtiff packs a pixel into an integer with red in the lowest byte.
  static_assert(std::endian::native == std::endian::little);
  auto* pixels = reinterpret_cast<std::uint32_t*>(picture->pixels.data());
  if (TIFFReadRGBAImageOriented(tiff.get(), width, height, pixels, ORIENTATION_TOPLEFT, 1) == 0)
    return damaged_picture("a damaged TIFF");
  if (has_opacity(tiff.get()))
    straighten_opacity(picture->pixels);
  else
    make_opaque(picture->pixels);
  return picture;
}

}  // namespace vitrine::inline codec
