// SPDX-License-Identifier: Apache-2.0
#include "codec/import/image.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>

#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMostPixelsPerByte = 1024;

// An image format that is not supported. It is recognised by the text `magic` at byte offset `at`;
// `type` is its media type.
struct Format {
  std::string_view type;
  std::size_t at;
  std::string_view magic;
};
constexpr std::array<Format, 8> kOthers{{{"image/webp", 8, "WEBP"},
                                         {"image/ktx2", 0, "\xABKTX 20"},
                                         {"image/avif", 4, "ftypavif"},
                                         {"image/tiff", 0, {"II*\0", 4}},
                                         {"image/tiff", 0, {"MM\0*", 4}},
                                         {"image/gif", 0, "GIF8"},
                                         {"image/bmp", 0, "BM"},
                                         {"image/vnd-ms.dds", 0, "DDS "}}};

bool starts_with(Bytes bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

Unexpected unread(Bytes bytes) {
  for (const auto& [type, at, magic] : kOthers) {
    if (bytes.size() < at || !starts_with(bytes.subspan(at), magic)) continue;
    return fail(ErrorCode::kUnsupported, "is " + std::string(type) + "; convert it to PNG or JPEG");
  }
  return fail(ErrorCode::kUnsupported, "is neither PNG nor JPEG; convert it to one of them");
}

Expected<Image> blank(std::uint64_t width, std::uint64_t height, std::size_t bytes,
                      std::uint64_t most_pixels) {
  if (width == 0 || height == 0 || width > 1 << 24 || height > 1 << 24 ||
      width * height > kMostPixelsPerByte * bytes) {
    return bad_input("is damaged");
  }
  if (width * height > most_pixels) {
    return fail(ErrorCode::kLimit, "has too many pixels");
  }
  Image image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  image.pixels.resize(4 * width * height);
  return image;
}

Expected<Image> decode_png(Bytes bytes, std::uint64_t most_pixels) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&png, png_image_free);
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) {
    return bad_input("is a damaged PNG");
  }
  auto image = blank(png.width, png.height, bytes.size(), most_pixels);
  if (!image) return image;
  png.format = PNG_FORMAT_RGBA;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  if (png_image_finish_read(&png, nullptr, image->pixels.data(), 0, nullptr) == 0) {
    return bad_input("is a damaged PNG");
  }
  return image;
}

Expected<Image> decode_jpeg(Bytes bytes, std::uint64_t most_pixels) {
  const std::unique_ptr<void, decltype(&tjDestroy)> jpeg(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, sampling = 0, space = 0;
  if (!jpeg || tjDecompressHeader3(jpeg.get(), bytes.data(), bytes.size(), &width, &height,
                                   &sampling, &space) != 0) {
    return bad_input("is a damaged JPEG");
  }
  auto image = blank(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                     bytes.size(), most_pixels);
  if (!image) return image;
  if (tjDecompress2(jpeg.get(), bytes.data(), bytes.size(), image->pixels.data(), width, 0, height,
                    TJPF_RGBA, TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0) {
    return bad_input("is a damaged JPEG, or one not in RGB");
  }
  return image;
}

std::uint32_t wrapped(std::int64_t i, std::uint32_t size, Wrap wrap) {
  const std::int64_t n = size;
  if (wrap == Wrap::kClamp)
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const std::int64_t at = (i % period + period) % period;
  return static_cast<std::uint32_t>(at < n ? at : 2 * n - 1 - at);
}

// Two neighbouring pixels along one axis. `weight` is the weight of the second pixel.
struct PixelPair {
  std::uint32_t first, second;
  double weight;
};

PixelPair pixels_around(double t, std::uint32_t size, Wrap wrap) {
  constexpr double kFar = 1e9;
  const double x = (std::abs(t) < kFar ? t : 0) * size - 0.5;
  const double floor = std::floor(x);
  const auto i = static_cast<std::int64_t>(floor);
  return {wrapped(i, size, wrap), wrapped(i + 1, size, wrap), x - floor};
}

}  // namespace

Expected<Image> decode_image(Bytes bytes, std::uint64_t most_pixels) {
  if (starts_with(bytes, "\x89PNG")) return decode_png(bytes, most_pixels);
  if (starts_with(bytes, "\xFF\xD8\xFF")) return decode_jpeg(bytes, most_pixels);
  return unread(bytes);
}

LinearColour sample(const Image& image, double u, double v, Wrap wrap_u, Wrap wrap_v) {
  const PixelPair x = pixels_around(u, image.width, wrap_u),
                  y = pixels_around(v, image.height, wrap_v);
  const auto row = [&](std::uint32_t at) {
    return to_linear(image.at(x.first, at)) * (1 - x.weight) +
           to_linear(image.at(x.second, at)) * x.weight;
  };
  return row(y.first) * (1 - y.weight) + row(y.second) * y.weight;
}

}  // namespace vitrine::inline codec
