// SPDX-License-Identifier: Apache-2.0
#include "codec/import/image.h"

#include <gmock/gmock.h>

#include <limits>

#include "codec/import/mesh_builders.h"
#include "codec/import/pictures.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::as_bytes;
using vitrine::testing::jpeg_of;
using vitrine::testing::png_of;
using vitrine::testing::red_and_blue;

std::string fault(const std::string& bytes, std::uint64_t most_pixels = kMostPixels) {
  const auto image = decode_image(as_bytes(bytes), most_pixels);
  EXPECT_FALSE(image.has_value());
  return image ? "" : image.error().message;
}

TEST(Image, PngComesBackExactly) {
  const auto image = decode_image(as_bytes(png_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 2)), 4);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 2u);
  EXPECT_EQ(image->height, 2u);
  EXPECT_EQ(image->at(0, 0), (Colour{1, 2, 3}));
  EXPECT_EQ(image->at(1, 1), (Colour{10, 11, 12}));
}

TEST(Image, JpegComesBackNearly) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 64; ++i)
    pixels.insert(pixels.end(), {200, 100, 50});
  const auto image = decode_image(as_bytes(jpeg_of(pixels, 8)), kMostPixels);
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->at(3, 3)[0], 200, 3);
  EXPECT_NEAR(image->at(3, 3)[1], 100, 3);
  EXPECT_NEAR(image->at(3, 3)[2], 50, 3);
}

TEST(Image, RefusesOtherContentAndDamage) {
  EXPECT_EQ(fault("P6 1 1 255 ..."), "is neither PNG nor JPEG; convert it to one of them");
  EXPECT_EQ(fault("GIF89a"), "is image/gif; convert it to PNG or JPEG");
  EXPECT_EQ(fault(std::string("II*\0", 4)), "is image/tiff; convert it to PNG or JPEG");
  EXPECT_EQ(fault("RIFF....WAVE"), "is neither PNG nor JPEG; convert it to one of them");
  EXPECT_EQ(fault(red_and_blue().substr(0, 40)), "is a damaged PNG");
  EXPECT_THAT(fault(jpeg_of(std::vector<std::uint8_t>(192, 9), 8).substr(0, 300)),
              HasSubstr("is a damaged JPEG"));
}

TEST(Image, RefusesASizeBeforeItAllocates) {
  EXPECT_EQ(fault(red_and_blue(), 1), "has too many pixels");
  std::string header = "\x89PNG\r\n\x1a\n";
  header +=
      std::string("\0\0\0\rIHDR\0\x0f\x42\x40\0\x0f\x42\x40\x08\x02\0\0\0\x53\x55\x61\x1b", 25);
  EXPECT_THAT(fault(header), HasSubstr("damaged"));
}

TEST(Image, IsSampledBetweenPixelCentresInLinearLight) {
  const auto image = *decode_image(as_bytes(red_and_blue()), 2);
  const auto at = [&](double u, Wrap wrap = Wrap::kRepeat) {
    return to_srgb(sample(image, u, 0.3, wrap, wrap));
  };
  EXPECT_EQ(at(0.25), (Colour{255, 0, 0}));
  EXPECT_EQ(at(0.75), (Colour{0, 0, 255}));
  EXPECT_EQ(at(0.5), (Colour{188, 0, 188}));  // sRGB value of half the light of each colour
  EXPECT_EQ(at(1.25), (Colour{255, 0, 0}));
  EXPECT_EQ(at(-0.25), (Colour{0, 0, 255}));
  EXPECT_EQ(at(1.25, Wrap::kClamp), (Colour{0, 0, 255}));
  EXPECT_EQ(at(-0.25, Wrap::kMirror), (Colour{255, 0, 0}));
  EXPECT_EQ(at(1.25, Wrap::kMirror), (Colour{0, 0, 255}));
}

TEST(Image, CoordinatesOfAnyKindAreSampled) {
  const auto image = *decode_image(as_bytes(red_and_blue()), 2);
  for (const double u : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300, 1e8, -1e8,
                         std::numeric_limits<double>::infinity()}) {
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp}) {
      const Colour colour = to_srgb(sample(image, u, u, wrap, wrap));
      EXPECT_EQ(colour[1], 0);
    }
  }
}

}  // namespace
}  // namespace vitrine
