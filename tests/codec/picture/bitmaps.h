// SPDX-License-Identifier: Apache-2.0
// Small TIFF, BMP and TGA files, written byte by byte.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::testing {

inline std::string little_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i)
    out += static_cast<char>(value >> 8 * i & 0xFF);
  return out;
}

// Converts RGB bytes to BGR bytes, in rows of `width` pixels from bottom to top. Pads each row with
// zeros to a multiple of `row_unit` bytes.
inline std::string upwards(const std::vector<std::uint8_t>& pixels, std::size_t width,
                           std::size_t row_unit) {
  std::string out;
  for (std::size_t row = pixels.size() / 3 / width; row-- > 0;) {
    for (std::size_t x = 0; x < width; ++x) {
      for (const std::size_t k : {2U, 1U, 0U})
        out += static_cast<char>(pixels[3 * (row * width + x) + k]);
    }
    out.append((row_unit - 3 * width % row_unit) % row_unit, '\0');
  }
  return out;
}

// Returns a BMP file. `pixels` holds RGB bytes, in rows from top to bottom.
inline std::string bmp_of(const std::vector<std::uint8_t>& pixels, std::size_t width) {
  const std::string rows = upwards(pixels, width, 4);
  return "BM" + little_endian(54 + rows.size(), 4) + little_endian(0, 4) + little_endian(54, 4) +
         little_endian(40, 4) + little_endian(width, 4) +
         little_endian(pixels.size() / 3 / width, 4) + little_endian(1, 2) + little_endian(24, 2) +
         little_endian(0, 4) + little_endian(rows.size(), 4) + std::string(16, '\0') + rows;
}

// Returns the header of a TGA file with 24 bits per pixel. Type 2 has plain pixels, type 10
// run-length encoded ones.
inline std::string tga_header(std::size_t width, std::size_t height, int type) {
  return std::string(2, '\0') + static_cast<char>(type) + std::string(9, '\0') +
         little_endian(width, 2) + little_endian(height, 2) + little_endian(24, 2);
}

// Returns a TGA file. `pixels` holds RGB bytes, in rows from top to bottom.
inline std::string tga_of(const std::vector<std::uint8_t>& pixels, std::size_t width) {
  return tga_header(width, pixels.size() / 3 / width, 2) + upwards(pixels, width, 1);
}

// The pixels of a TIFF file with one row.
struct TiffRow {
  std::string samples;       // bytes of the pixels
  std::size_t width = 2;     // number of pixels
  std::size_t channels = 3;  // samples per pixel
  std::size_t bits = 8;      // bits per sample
  std::uint64_t kind = 2;    // PhotometricInterpretation: 1 grey, 2 RGB, 5 CMYK
  bool has_opacity = false;  // whether the last channel is straight opacity
  bool has_mask = false;     // whether the last channel is an extra channel of unspecified meaning
  std::uint64_t height = 1;  // number of rows that the header states

  std::string file() const;
};

inline std::string TiffRow::file() const {
  constexpr std::size_t kHeader = 8;
  std::string bits_per_channel;
  for (std::size_t i = 0; i < channels; ++i)
    bits_per_channel += little_endian(bits, 2);
  std::string entries;
  int count = 0;
  const auto entry = [&](int tag, int type, std::uint64_t number, std::uint64_t value) {
    entries += little_endian(static_cast<std::uint64_t>(tag), 2) +
               little_endian(static_cast<std::uint64_t>(type), 2) + little_endian(number, 4) +
               little_endian(value, 4);
    ++count;
  };
  const std::size_t bits_at = kHeader + samples.size();
  entry(256, 3, 1, width);
  entry(257, 3, 1, height);
  if (channels > 2)
    entry(258, 3, channels, bits_at);
  else
    entry(258, 3, 1, bits);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, kind);
  entry(273, 4, 1, kHeader);
  entry(277, 3, 1, channels);
  entry(278, 3, 1, height);
  entry(279, 4, 1, samples.size());
  if (has_opacity || has_mask) entry(338, 3, 1, has_opacity ? 2 : 0);
  return "II*" + std::string(1, '\0') + little_endian(bits_at + bits_per_channel.size(), 4) +
         samples + bits_per_channel + little_endian(static_cast<std::uint64_t>(count), 2) +
         entries + std::string(4, '\0');
}

// Returns a TIFF file of one row. `pixels` holds RGB bytes.
inline std::string tiff_of(const std::vector<std::uint8_t>& pixels) {
  return TiffRow{.samples = {pixels.begin(), pixels.end()}, .width = pixels.size() / 3}.file();
}

}  // namespace vitrine::testing
