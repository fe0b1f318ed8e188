// SPDX-License-Identifier: Apache-2.0
// Small pictures, encoded by the same libraries that decode them.
#pragma once

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>
#include <webp/encode.h>

#include <functional>
#include <string>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::testing {

// The pixel colours of red_and_blue(), and the colour halfway between them in linear light.
inline constexpr Colour kRed{255, 0, 0}, kBlue{0, 0, 255}, kBetween{188, 0, 188};

// Returns a PNG file. `pixels` holds RGB bytes, in rows from top to bottom.
inline std::string png_of(const std::vector<std::uint8_t>& pixels, std::uint32_t width) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = static_cast<std::uint32_t>(pixels.size() / 3 / width);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  EXPECT_TRUE(png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr));
  std::string out(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr));
  out.resize(size);
  return out;
}

// A PNG file whose pixels have a given libpng colour type, such as PNG_COLOR_TYPE_GRAY.
struct StoredPng {
  int type = PNG_COLOR_TYPE_RGB, depth = 8;
  std::uint32_t width = 1;
  std::vector<std::vector<std::uint8_t>> rows = {};
  bool is_interlaced = false;
  std::function<void(png_structp, png_infop)> add_chunks = [](png_structp, png_infop) {};

  std::string file() const;
};

inline std::string StoredPng::file() const {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp self, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(self))
        ->append(reinterpret_cast<const char*>(data), size);
  };
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, width, static_cast<std::uint32_t>(rows.size()), depth, type,
               is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  add_chunks(png, info);
  png_write_info(png, info);
  const int passes = png_set_interlace_handling(png);
  for (int pass = 0; pass < passes; ++pass) {
    for (const auto& row : rows)
      png_write_row(png, row.data());
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

inline std::string jpeg_of(const std::vector<std::uint8_t>& pixels, int width) {
  const tjhandle jpeg = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const int height = static_cast<int>(pixels.size()) / 3 / width;
  EXPECT_EQ(
      tjCompress2(jpeg, pixels.data(), width, 0, height, TJPF_RGB, &data, &size, TJSAMP_444, 95, 0),
      0);
  std::string out(reinterpret_cast<const char*>(data), size);
  tjFree(data);
  tjDestroy(jpeg);
  return out;
}

// Copies a buffer of libwebp to a string and frees the buffer.
inline std::string take_webp(std::uint8_t* data, std::size_t size) {
  EXPECT_GT(size, 0u);
  std::string out(reinterpret_cast<const char*>(data), size);
  WebPFree(data);
  return out;
}

// Returns a lossless WebP file. `pixels` holds RGB bytes, in rows from top to bottom.
inline std::string webp_of(const std::vector<std::uint8_t>& pixels, int width) {
  std::uint8_t* data = nullptr;
  const int height = static_cast<int>(pixels.size()) / 3 / width;
  const std::size_t size = WebPEncodeLosslessRGB(pixels.data(), width, height, 3 * width, &data);
  return take_webp(data, size);
}

inline std::string lossy_webp_of(const std::vector<std::uint8_t>& pixels, int width) {
  std::uint8_t* data = nullptr;
  const int height = static_cast<int>(pixels.size()) / 3 / width;
  const std::size_t size = WebPEncodeRGB(pixels.data(), width, height, 3 * width, 90, &data);
  return take_webp(data, size);
}

// Returns a PNG of two pixels: red at the left, blue at the right.
inline std::string red_and_blue() {
  return png_of({255, 0, 0, 0, 0, 255}, 2);
}

}  // namespace vitrine::testing
