// SPDX-License-Identifier: Apache-2.0
// fuzz_picture_seeds FOLDER: writes a seed of each picture format for the picture fuzzer.
#include <fstream>

#include "codec/picture/bitmaps.h"
#include "codec/picture/pictures.h"

int main(int argc, char** argv) {
  using namespace vitrine::testing;
  if (argc != 2) return 2;
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 16 * 16; ++i)
    pixels.insert(pixels.end(), {static_cast<std::uint8_t>(16 * i), static_cast<std::uint8_t>(i),
                                 static_cast<std::uint8_t>(i * i)});
  const std::pair<const char*, std::string> seeds[] = {{"png", png_of(pixels, 16)},
                                                       {"jpeg", jpeg_of(pixels, 16)},
                                                       {"webp_lossless", webp_of(pixels, 16)},
                                                       {"webp_lossy", lossy_webp_of(pixels, 16)},
                                                       {"bmp", bmp_of(pixels, 16)},
                                                       {"tga", tga_of(pixels, 16)},
                                                       {"tiff", tiff_of(pixels)}};
  for (const auto& [name, bytes] : seeds)
    std::ofstream(std::string(argv[1]) + '/' + name, std::ios::binary) << bytes;
  return 0;
}
