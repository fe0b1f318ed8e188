// SPDX-License-Identifier: Apache-2.0
#include "codec/render/mip_map.h"

#include <gtest/gtest.h>

#include "textured_square.h"

namespace vitrine::test {
namespace {

// Returns a picture of one row of grey pixels.
Picture row_of(const std::vector<std::uint8_t>& greys) {
  return picture_of(static_cast<std::uint32_t>(greys.size()), 1,
                    [&](int x, int) -> std::array<std::uint8_t, 4> {
                      const std::uint8_t grey = greys[static_cast<std::size_t>(x)];
                      return {grey, grey, grey, 255};
                    });
}

double value_at(const MipMap& mip_map, float u, double level) {
  return 255 * mip_map.at({u, 0.5f}, level, Wrap::kClamp, Wrap::kClamp)[0];
}

TEST(MipMap, EachLevelIsTheMeanOfTheAreaThatAPixelCovers) {
  const Picture even = row_of({10, 30, 50, 90});
  const MipMap halves(even, PictureCoding::kValues);
  EXPECT_NEAR(value_at(halves, 0.25f, 1), 20, 0.01);
  EXPECT_NEAR(value_at(halves, 0.75f, 1), 70, 0.01);
  EXPECT_NEAR(value_at(halves, 0.5f, 2), 45, 0.01);
  // Five pixels become two, so each new pixel is the mean of two and a half pixels.
  const Picture odd = row_of({10, 20, 100, 60, 70});
  const MipMap shares(odd, PictureCoding::kValues);
  EXPECT_NEAR(value_at(shares, 0.25f, 1), (10 + 20 + 50) / 2.5, 0.01);
  EXPECT_NEAR(value_at(shares, 0.75f, 1), (50 + 60 + 70) / 2.5, 0.01);
}

TEST(MipMap, ColoursAreAveragedInLinearLight) {
  const Picture picture = row_of({0, 255});
  const MipMap colours(picture, PictureCoding::kSrgb), values(picture, PictureCoding::kValues);
  EXPECT_NEAR(value_at(colours, 0.5f, 1), 127.5, 1);
  EXPECT_NEAR(value_at(colours, 0.5f, 0), 127.5, 0.01);
  EXPECT_NEAR(value_at(values, 0.5f, 1), 127.5, 0.51);  // 127.5 is rounded to a whole byte
}

TEST(MipMap, BetweenTwoLevelsTheValueIsInterpolated) {
  const Picture picture = row_of({0, 100});
  const MipMap mip_map(picture, PictureCoding::kValues);
  EXPECT_NEAR(value_at(mip_map, 0.25f, 0), 0, 0.01);
  EXPECT_NEAR(value_at(mip_map, 0.25f, 0.5), 25, 0.01);
  EXPECT_NEAR(value_at(mip_map, 0.25f, 1), 50, 0.01);
}

TEST(MipMap, LevelsThatDoNotExistAreThoseAtTheEnd) {
  const Picture picture = row_of({0, 100});
  const MipMap mip_map(picture, PictureCoding::kValues);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double level : {-kInfinity, -3.0, std::nan("")})
    EXPECT_NEAR(value_at(mip_map, 0.25f, level), 0, 0.01);
  for (const double level : {1.0, 7.0, kInfinity})
    EXPECT_NEAR(value_at(mip_map, 0.25f, level), 50, 0.01);
}

}  // namespace
}  // namespace vitrine::test
