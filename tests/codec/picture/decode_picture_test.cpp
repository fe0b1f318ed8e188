// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/decode_picture.h"

#include <gmock/gmock.h>

#include <limits>

#include "codec/core/limits.h"
#include "codec/picture/pictures.h"
#include "support/as_bytes.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using vitrine::testing::as_bytes;
using vitrine::testing::jpeg_of;
using vitrine::testing::lossy_webp_of;
using vitrine::testing::png_of;
using vitrine::testing::red_and_blue;
using vitrine::testing::StoredPng;
using vitrine::testing::webp_of;

std::string fault(const std::string& bytes, std::uint64_t most_pixels = Limits{}.pixels) {
  const auto image = decode_picture(as_bytes(bytes), most_pixels);
  EXPECT_FALSE(image.has_value());
  return image ? "" : image.error().message;
}

TEST(DecodePicture, PngComesBackExactly) {
  const auto image =
      decode_picture(as_bytes(png_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 2)), 4);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 2u);
  EXPECT_EQ(image->height, 2u);
  EXPECT_EQ(image->at(0, 0), (Colour{1, 2, 3}));
  EXPECT_EQ(image->at(1, 1), (Colour{10, 11, 12}));
}

std::vector<std::uint8_t> pixels_of(const StoredPng& png) {
  const auto picture = decode_picture(as_bytes(png.file()), Limits{}.pixels);
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? picture->pixels : std::vector<std::uint8_t>();
}

TEST(DecodePicture, TheGammaOfAPngChangesNoPixel) {
  const auto linear = [](png_structp png, png_infop info) { png_set_gAMA(png, info, 1.0); };
  EXPECT_THAT(
      pixels_of({.width = 2, .rows = {{10, 100, 200, 128, 128, 255}}, .add_chunks = linear}),
      ElementsAre(10, 100, 200, 255, 128, 128, 255, 255));
  EXPECT_THAT(pixels_of({.type = PNG_COLOR_TYPE_GRAY, .rows = {{128}}, .add_chunks = linear}),
              ElementsAre(128, 128, 128, 255));
  EXPECT_THAT(
      pixels_of({.depth = 16, .rows = {{0x12, 0xFF, 0x80, 0, 0xFF, 0xFF}}, .add_chunks = linear}),
      ElementsAre(0x13, 0x80, 0xFF, 255));
}

TEST(DecodePicture, AGreyPngBecomesColours) {
  EXPECT_THAT(
      pixels_of({.type = PNG_COLOR_TYPE_GRAY, .depth = 1, .width = 2, .rows = {{0b0100'0000}}}),
      ElementsAre(0, 0, 0, 255, 255, 255, 255, 255));
  EXPECT_THAT(pixels_of({.type = PNG_COLOR_TYPE_GRAY_ALPHA, .rows = {{7, 9}}}),
              ElementsAre(7, 7, 7, 9));
}

TEST(DecodePicture, APaletteBecomesColoursAndOpacities) {
  const StoredPng png{.type = PNG_COLOR_TYPE_PALETTE,
                      .depth = 2,
                      .width = 2,
                      .rows = {{0b0001'0000}},
                      .add_chunks = [](png_structp self, png_infop info) {
                        const png_color colours[]{{1, 2, 3}, {4, 5, 6}};
                        const png_byte opacities[]{77};
                        png_set_PLTE(self, info, colours, 2);
                        png_set_tRNS(self, info, opacities, 1, nullptr);
                      }};
  EXPECT_THAT(pixels_of(png), ElementsAre(1, 2, 3, 77, 4, 5, 6, 255));
}

TEST(DecodePicture, TheTransparentColourOfAPngBecomesOpacity) {
  const StoredPng png{
      .width = 2, .rows = {{1, 2, 3, 4, 5, 6}}, .add_chunks = [](png_structp self, png_infop info) {
        png_color_16 colour{};
        colour.red = 4, colour.green = 5, colour.blue = 6;
        png_set_tRNS(self, info, nullptr, 0, &colour);
      }};
  EXPECT_THAT(pixels_of(png), ElementsAre(1, 2, 3, 255, 4, 5, 6, 0));
}

// An interlaced PNG of at least 8 x 8 pixels has pixels in each of its seven passes.
TEST(DecodePicture, AnInterlacedPngComesBackExactly) {
  StoredPng png{.type = PNG_COLOR_TYPE_RGBA, .width = 11, .is_interlaced = true};
  std::vector<std::uint8_t> all;
  for (std::uint8_t y = 0; y < 9; ++y) {
    auto& row = png.rows.emplace_back();
    for (std::uint8_t k = 0; k < 44; ++k)
      row.push_back(static_cast<std::uint8_t>(y * 31 + k * 5));
    all.insert(all.end(), row.begin(), row.end());
  }
  EXPECT_EQ(pixels_of(png), all);
  const std::string file = png.file();
  EXPECT_EQ(fault(file.substr(0, file.size() - 40)), "is a damaged PNG; export it again");
}

TEST(DecodePicture, JpegComesBackNearly) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 64; ++i)
    pixels.insert(pixels.end(), {200, 100, 50});
  const auto image = decode_picture(as_bytes(jpeg_of(pixels, 8)), Limits{}.pixels);
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->at(3, 3)[0], 200, 3);
  EXPECT_NEAR(image->at(3, 3)[1], 100, 3);
  EXPECT_NEAR(image->at(3, 3)[2], 50, 3);
}

TEST(DecodePicture, LosslessWebpComesBackExactly) {
  const auto picture =
      decode_picture(as_bytes(webp_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 2)), 4);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 2u);
  EXPECT_EQ(picture->height, 2u);
  EXPECT_EQ(picture->at(0, 0), (Colour{1, 2, 3}));
  EXPECT_EQ(picture->at(1, 1), (Colour{10, 11, 12}));
}

TEST(DecodePicture, LossyWebpComesBackNearly) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 64; ++i)
    pixels.insert(pixels.end(), {200, 100, 50});
  const auto picture = decode_picture(as_bytes(lossy_webp_of(pixels, 8)), 64);
  ASSERT_TRUE(picture);
  EXPECT_NEAR(picture->at(3, 3)[0], 200, 3);
  EXPECT_NEAR(picture->at(3, 3)[1], 100, 3);
  EXPECT_NEAR(picture->at(3, 3)[2], 50, 3);
}

TEST(DecodePicture, AWebpOfOneColourMayHaveFewBytes) {
  std::vector<std::uint8_t> pixels(3 * 1024 * 1024, 77);
  const std::string bytes = webp_of(pixels, 1024);
  ASSERT_LT(1024 * bytes.size(), 1024u * 1024u);
  const auto picture = decode_picture(as_bytes(bytes), Limits{}.pixels);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->at(1000, 1000), (Colour{77, 77, 77}));
}

// Returns a JPEG in CMYK. `pixels` holds inverted CMYK bytes, in rows of `width` pixels.
std::string cmyk_jpeg_of(const std::vector<std::uint8_t>& pixels, int width) {
  const tjhandle jpeg = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const int height = static_cast<int>(pixels.size()) / 4 / width;
  EXPECT_EQ(tjCompress2(jpeg, pixels.data(), width, 0, height, TJPF_CMYK, &data, &size, TJSAMP_444,
                        100, 0),
            0);
  std::string out(reinterpret_cast<const char*>(data), size);
  tjFree(data);
  tjDestroy(jpeg);
  return out;
}

TEST(DecodePicture, AJpegInCmykBecomesRgb) {
  const std::vector<std::array<std::uint8_t, 4>> inks{
      {255, 0, 0, 255}, {255, 255, 255, 128}, {0, 200, 100, 255}};
  const std::vector<Colour> colours{{255, 0, 0}, {128, 128, 128}, {0, 200, 100}};
  for (std::size_t i = 0; i < inks.size(); ++i) {
    std::vector<std::uint8_t> pixels;
    for (int k = 0; k < 64; ++k)
      pixels.insert(pixels.end(), inks[i].begin(), inks[i].end());
    const auto picture = decode_picture(as_bytes(cmyk_jpeg_of(pixels, 8)), Limits{}.pixels);
    ASSERT_TRUE(picture) << picture.error().message;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(picture->at(4, 4)[k], colours[i][k], 4);
    EXPECT_EQ(picture->pixels[3], 255);
  }
}

// Half of each coloured ink and no black ink is grey. Read as inverted values, it would be black.
TEST(DecodePicture, AJpegInCmykWithoutAdobesSegmentIsNotInverted) {
  std::vector<std::uint8_t> pixels;
  for (int k = 0; k < 64; ++k)
    pixels.insert(pixels.end(), {128, 128, 128, 0});
  std::string bytes = cmyk_jpeg_of(pixels, 8);
  const std::size_t adobe = bytes.find("\xFF\xEE");
  ASSERT_NE(adobe, bytes.npos);
  bytes.erase(adobe, 2 + static_cast<std::size_t>(bytes[adobe + 3]));
  const auto picture = decode_picture(as_bytes(bytes), Limits{}.pixels);
  ASSERT_TRUE(picture) << picture.error().message;
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(picture->at(4, 4)[k], 127, 4);
}

TEST(DecodePicture, NamesOtherFormats) {
  EXPECT_EQ(fault("8BPS" + std::string(60, '\0')),
            "is image/vnd.adobe.photoshop; convert it to PNG, JPEG or WebP");
}

TEST(DecodePicture, RefusesOtherContentAndDamage) {
  EXPECT_EQ(fault("P6 1 1 255 ..."),
            "is not PNG, JPEG, WebP, TIFF, BMP or TGA; convert it to one of them");
  EXPECT_EQ(fault("GIF89a"), "is image/gif; convert it to PNG, JPEG or WebP");
  EXPECT_EQ(fault("RIFF....WAVE"),
            "is not PNG, JPEG, WebP, TIFF, BMP or TGA; convert it to one of them");
  EXPECT_EQ(fault(red_and_blue().substr(0, 40)), "is a damaged PNG; export it again");
  EXPECT_EQ(fault(jpeg_of(std::vector<std::uint8_t>(192, 9), 8).substr(0, 300)),
            "is a damaged JPEG; export it again");
  const std::string webp = webp_of(std::vector<std::uint8_t>(192, 9), 8);
  EXPECT_EQ(fault(webp.substr(0, 20)), "is a damaged WebP; export it again");
  EXPECT_EQ(fault(webp.substr(0, webp.size() - 6)), "is a damaged WebP; export it again");
}

TEST(DecodePicture, RefusesASizeBeforeItAllocates) {
  EXPECT_EQ(fault(red_and_blue(), 1), "has too many pixels; make it smaller");
  std::string header = "\x89PNG\r\n\x1a\n";
  header +=
      std::string("\0\0\0\rIHDR\0\x0f\x42\x40\0\x0f\x42\x40\x08\x02\0\0\0\x53\x55\x61\x1b", 25);
  EXPECT_EQ(fault(header), "is a damaged PNG; export it again");
}

TEST(DecodePicture, ADamagedPictureCountsAsDecodedPixels) {
  const std::string intact = png_of(std::vector<std::uint8_t>(300, 7), 10);
  std::uint64_t left = 250;
  EXPECT_TRUE(decode_picture_within(left, as_bytes(intact)));
  EXPECT_EQ(left, 150u);
  EXPECT_FALSE(decode_picture_within(left, as_bytes(intact.substr(0, intact.size() - 20))));
  EXPECT_EQ(left, 50u);
  EXPECT_FALSE(decode_picture_within(left, as_bytes(intact)));
  EXPECT_EQ(left, 50u);
}

// Returns a WebP whose header states a false size. A lossless WebP stores width - 1 and height - 1
// in bytes 21 to 24, with 14 bits each.
std::string webp_that_claims(std::uint32_t width, std::uint32_t height) {
  std::string bytes = webp_of({1, 2, 3}, 1);
  const std::uint32_t size = (height - 1) << 14 | (width - 1);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[21 + i] = static_cast<char>(size >> 8 * i);
  return bytes;
}

TEST(DecodePicture, RefusesTheSizeOfAWebpBeforeItAllocates) {
  EXPECT_EQ(fault(webp_that_claims(16'383, 16'383)), "is damaged; export it again");
  EXPECT_EQ(fault(webp_that_claims(2, 1), 1), "has too many pixels; make it smaller");
}

TEST(DecodePicture, RefusesAnAnimatedWebp) {
  std::string bytes("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\0\0\0\0\0\0", 30);
  EXPECT_EQ(fault(bytes), "is an animated WebP; convert it to a still picture");
}

}  // namespace
}  // namespace vitrine
