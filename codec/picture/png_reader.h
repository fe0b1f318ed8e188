// SPDX-License-Identifier: Apache-2.0
// Reads the pixels of a PNG as they are stored. Ignores data about the colour space, such as gamma
// and ICC profiles, as glTF requires ([glTF] section 3.8.3).
#pragma once

#include <png.h>

#include <cstdint>
#include <span>

namespace vitrine::inline codec {

class PngReader {
 public:
  // `bytes` must outlive this object.
  explicit PngReader(std::span<const std::uint8_t> bytes);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  // Reads the size. Returns false if the PNG is damaged. Call this first and only once.
  bool read_header();

  std::uint32_t width() const { return png_get_image_width(png_, info_); }
  std::uint32_t height() const { return png_get_image_height(png_, info_); }

  // Writes the rows to `pixels`, with four bytes per pixel: red, green, blue and opacity. Greys and
  // palette indices are converted to colours, 16-bit values to 8 bits. Returns false if the PNG is
  // damaged. Call this after read_header() and only once.
  bool read_pixels(std::uint8_t* pixels);

 private:
  void begin();
  void read_rows(std::uint8_t* pixels);

  std::span<const std::uint8_t> left_;  // bytes that libpng has not read yet
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace vitrine::inline codec
