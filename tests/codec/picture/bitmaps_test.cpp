// SPDX-License-Identifier: Apache-2.0
// Tests TIFF, BMP and TGA pictures.
#include "codec/picture/bitmaps.h"

#include <gmock/gmock.h>

#include "codec/picture/decode_picture.h"
#include "support/as_bytes.h"

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using vitrine::testing::as_bytes;
using vitrine::testing::bmp_of;
using vitrine::testing::tga_header;
using vitrine::testing::tga_of;
using vitrine::testing::tiff_of;
using vitrine::testing::TiffRow;
using vitrine::testing::upwards;

// A picture of three pixels by two. In a BMP file, its rows have padding.
const std::vector<std::uint8_t> kSixPixels{255, 0, 0, 0,  255, 0,  0, 0, 255,
                                           1,   2, 3, 40, 50,  60, 7, 8, 9};
const std::vector<std::uint8_t> kSixDecoded{255, 0, 0, 255, 0,  255, 0,  255, 0, 0, 255, 255,
                                            1,   2, 3, 255, 40, 50,  60, 255, 7, 8, 9,   255};

std::vector<std::uint8_t> decoded(const std::string& bytes) {
  const auto picture = decode_picture(as_bytes(bytes), 1'000'000);
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? picture->pixels : std::vector<std::uint8_t>();
}

std::string bitmap_fault(const std::string& bytes, std::uint64_t most_pixels = 1'000'000) {
  const auto picture = decode_picture(as_bytes(bytes), most_pixels);
  EXPECT_FALSE(picture);
  return picture ? "" : picture.error().message;
}

TEST(Bitmaps, BmpAndTgaComeBackExactly) {
  EXPECT_THAT(decoded(bmp_of(kSixPixels, 3)), ElementsAreArray(kSixDecoded));
  EXPECT_THAT(decoded(tga_of(kSixPixels, 3)), ElementsAreArray(kSixDecoded));
  EXPECT_THAT(decoded(tga_of(kSixPixels, 3) + std::string(8, '\0') +
                      std::string("TRUEVISION-XFILE.\0", 18)),
              ElementsAreArray(kSixDecoded));
}

TEST(Bitmaps, RunsOfATgaAreRepeated) {
  const std::string run = tga_header(3, 2, 10) + std::string("\x85\x03\x02\x01", 4);
  const std::vector<std::uint8_t> pixels = decoded(run);
  ASSERT_EQ(pixels.size(), 24u);
  for (std::size_t i = 0; i < pixels.size(); i += 4)
    EXPECT_THAT(std::vector(&pixels[i], &pixels[i] + 4), ElementsAre(1, 2, 3, 255));
}

TEST(Bitmaps, AnUprightTgaKeepsItsRows) {
  std::string upright = tga_of(kSixPixels, 3);
  upright[17] = 0x20;
  const auto pixels = decoded(upright);
  ASSERT_EQ(pixels.size(), 24u);
  EXPECT_THAT(std::vector(&pixels[0], &pixels[0] + 4), ElementsAre(1, 2, 3, 255));
}

TEST(Bitmaps, TiffsOfEveryKindOfPixels) {
  EXPECT_THAT(decoded(tiff_of({255, 0, 0, 1, 2, 3})), ElementsAre(255, 0, 0, 255, 1, 2, 3, 255));
  EXPECT_THAT(decoded(TiffRow{.samples = {'\x0A', '\x64'}, .channels = 1, .kind = 1}.file()),
              ElementsAre(10, 10, 10, 255, 100, 100, 100, 255));
  EXPECT_THAT(
      decoded(TiffRow{.samples = std::string("\x34\x12\0\x80\xFF\xFF", 6), .width = 1, .bits = 16}
                  .file()),
      ElementsAre(0x12, 0x80, 255, 255));
  EXPECT_THAT(decoded(TiffRow{.samples = std::string("\xC8\x64\x32\x80\1\2\3\xFF", 8),
                              .channels = 4,
                              .has_opacity = true}
                          .file()),
              ElementsAre(199, 100, 50, 128, 1, 2, 3, 255));
  EXPECT_THAT(
      decoded(TiffRow{.samples = std::string("\0\xFF\xFF\0\0\0\0\xFF", 8), .channels = 4, .kind = 5}
                  .file()),
      ElementsAre(255, 0, 0, 255, 0, 0, 0, 255));
}

TEST(Bitmaps, GreyInCielabStaysGrey) {
  const auto pixels =
      decoded(TiffRow{.samples = std::string("\x89\0\0\xFF\0\0", 6), .kind = 8}.file());
  ASSERT_EQ(pixels.size(), 8u);
  const std::vector<int> expected{128, 128, 128, 255, 255, 255, 255, 255};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(pixels[i], expected[i], 6) << i;  // libtiff's curve is not quite that of sRGB
  EXPECT_EQ(pixels[0], pixels[2]);
}

TEST(Bitmaps, AMaskInATiffIsNoOpacity) {
  const TiffRow untagged{.samples = std::string("\xC8\x64\x32\x10\1\2\3\0", 8), .channels = 4};
  TiffRow unspecified = untagged;
  unspecified.has_mask = true;
  for (const TiffRow& row : {untagged, unspecified})
    EXPECT_THAT(decoded(row.file()), ElementsAre(200, 100, 50, 255, 1, 2, 3, 255));
}

TEST(Bitmaps, APictureCutAnywhereIsRefused) {
  constexpr std::size_t kUnread = 4;  // a TIFF's last bytes: the offset of the next page, not read
  for (const std::string& whole :
       {bmp_of(kSixPixels, 3), tga_of(kSixPixels, 3), tiff_of(kSixPixels)}) {
    for (std::size_t size = 0; size + kUnread < whole.size(); ++size)
      EXPECT_FALSE(decode_picture(as_bytes(whole.substr(0, size)), 1'000)) << size;
  }
}

TEST(Bitmaps, ChangedBytesGiveAPictureOrAnError) {
  for (const std::string& whole :
       {bmp_of(kSixPixels, 3), tga_of(kSixPixels, 3), tiff_of(kSixPixels)}) {
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      std::string bytes = whole;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      const auto picture = decode_picture(as_bytes(bytes), 1'000'000);
      if (picture)
        EXPECT_EQ(picture->pixels.size(), 4u * picture->width * picture->height);
      else
        EXPECT_EQ(picture.error().message.find('\n'), std::string::npos);
    }
  }
}

TEST(Bitmaps, ASizeBeyondTheBytesIsRefusedBeforeAllocating) {
  EXPECT_EQ(bitmap_fault(tga_header(65535, 65535, 10)), "is damaged; export it again");
  EXPECT_EQ(bitmap_fault(TiffRow{.samples = "abcdef", .height = 60'000}.file()),
            "is a damaged TIFF; export it again");
  EXPECT_EQ(bitmap_fault(bmp_of(kSixPixels, 3), 5), "has too many pixels; make it smaller");
  EXPECT_EQ(bitmap_fault(tga_of(kSixPixels, 3), 5), "has too many pixels; make it smaller");
  EXPECT_EQ(bitmap_fault(tiff_of(kSixPixels), 5), "has too many pixels; make it smaller");
}

TEST(Bitmaps, FaultsNameTheFormat) {
  EXPECT_EQ(bitmap_fault(std::string("II*\0", 4)), "is a damaged TIFF; export it again");
  EXPECT_EQ(bitmap_fault(std::string("MM\0+\0\b", 6)), "is a damaged TIFF; export it again");
  EXPECT_EQ(bitmap_fault("BM" + std::string(60, '\0')),
            "is a damaged or unusual BMP; convert it to PNG, JPEG or WebP");
  EXPECT_EQ(bitmap_fault(tga_of(kSixPixels, 3).substr(0, 30)), "is a damaged TGA; export it again");
  EXPECT_EQ(bitmap_fault(TiffRow{.samples = "abcdef", .kind = 9'999}.file()),
            "is a TIFF with an unusual kind of pixels or compression; convert it to PNG, JPEG or "
            "WebP");
}

}  // namespace
}  // namespace vitrine
