// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/squared_error.h"

#include <gtest/gtest.h>

#include "codec/appearance/backdrop.h"
#include "pictures.h"

namespace vitrine::test {
namespace {

TEST(SquaredError, EqualPicturesHaveNoRatio) {
  const Picture picture = random_picture(16, 16, 1);
  const SquaredError error = squared_error(picture, picture);
  EXPECT_EQ(error.sum, 0);
  EXPECT_EQ(error.bytes, 3u * 16 * 16);
  EXPECT_FALSE(psnr(error).has_value());
}

TEST(SquaredError, NoiseOfFiveLevelsHasTheRatioComputedByHand) {
  const Picture flat = grey_picture(8, 8, [](auto, auto) { return 100; });
  const Picture noisy = grey_picture(8, 8, [](auto x, auto y) { return (x + y) % 2 ? 105 : 95; });
  // The error is 5 everywhere: 10 * log10(255^2 / 5^2).
  EXPECT_NEAR(psnr(squared_error(flat, noisy)).value(), 34.1514, 1e-4);
}

TEST(SquaredError, OneColourOfThreeCountsAThird) {
  const Picture flat = grey_picture(8, 8, [](auto, auto) { return 100; });
  Picture reddish = flat;
  for (std::size_t at = 0; at < reddish.pixels.size(); at += 4)
    reddish.pixels[at] = 110;
  // One of three channels differs by 10: 10 * log10(255^2 / (10^2 / 3)).
  EXPECT_NEAR(psnr(squared_error(flat, reddish)).value(), 32.9020, 1e-4);
}

TEST(SquaredError, PixelsThatNeitherPictureCoversDoNotCount) {
  Picture a = grey_picture(4, 1, [](auto, auto) { return 100; }), b = a;
  b.pixels[0] = b.pixels[4] = b.pixels[8] = 0;
  a.pixels[3] = b.pixels[3] = 0;  // no picture covers pixel 0; only b covers pixel 1
  a.pixels[7] = 0;
  const SquaredError error = squared_error(a, b);
  EXPECT_EQ(error.bytes, 9u);
  EXPECT_EQ(error.sum, 2 * 100.0 * 100.0);
}

TEST(Backdrop, ColoursAreMixedWithGreyByTheirOpacity) {
  Picture picture{3, 1, {200, 0, 255, 255, 200, 0, 255, 0, 200, 0, 255, 51}};
  lay_over_grey(picture);
  const std::vector<std::uint8_t> expected = {200, 0, 255, 255, 128, 128,
                                              128, 0, 142, 102, 153, 51};
  EXPECT_EQ(picture.pixels, expected);
}

}  // namespace
}  // namespace vitrine::test
