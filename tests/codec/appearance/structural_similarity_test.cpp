// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/structural_similarity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pictures.h"

namespace vitrine::test {
namespace {

// Returns the SSIM of two pictures of 11 x 11 pixels by [WBSS04] eq. 12: luminance times contrast
// times structure. Unlike the code under test, it computes deviations from the mean, with
// two-dimensional weights.
double similarity_by_parts(const Picture& a, const Picture& b) {
  double weights[121], sum = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
  for (int i = 0; i < 121; ++i) {
    const int x = i % 11 - 5, y = i / 11 - 5;
    sum += weights[i] = std::exp(-(x * x + y * y) / 4.5);
  }
  for (int i = 0; i < 121; ++i) {
    ma += weights[i] / sum * a.pixels[4 * i];
    mb += weights[i] / sum * b.pixels[4 * i];
  }
  for (int i = 0; i < 121; ++i) {
    const double da = a.pixels[4 * i] - ma, db = b.pixels[4 * i] - mb;
    va += weights[i] / sum * da * da;
    vb += weights[i] / sum * db * db;
    cov += weights[i] / sum * da * db;
  }
  const double c1 = 6.5025, c2 = 58.5225, c3 = c2 / 2;
  const double luminance = (2 * ma * mb + c1) / (ma * ma + mb * mb + c1);
  const double contrast = (2 * std::sqrt(va * vb) + c2) / (va + vb + c2);
  return luminance * contrast * (cov + c3) / (std::sqrt(va * vb) + c3);
}

TEST(StructuralSimilarity, OneWindowAgreesWithTheProductOfItsThreeParts) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const Picture a = random_picture(11, 11, seed), b = random_picture(11, 11, seed + 10);
    EXPECT_NEAR(structural_similarity(a, b).value(), similarity_by_parts(a, b), 1e-9) << seed;
  }
}

TEST(StructuralSimilarity, EqualPicturesHaveOne) {
  const Picture picture = random_picture(40, 30, 4);
  EXPECT_NEAR(structural_similarity(picture, picture).value(), 1, 1e-12);
}

TEST(StructuralSimilarity, TheOrderOfThePicturesDoesNotMatter) {
  const Picture a = random_picture(40, 30, 5), b = random_picture(40, 30, 6);
  EXPECT_EQ(structural_similarity(a, b), structural_similarity(b, a));
}

TEST(StructuralSimilarity, LumaWeighsTheColours) {
  const Picture grey = random_picture(11, 11, 7);
  Picture greenish = grey, bluish = grey;
  for (std::size_t at = 0; at < grey.pixels.size(); at += 4) {
    greenish.pixels[at + 1] /= 2;
    bluish.pixels[at + 2] /= 2;
  }
  EXPECT_LT(structural_similarity(grey, greenish), structural_similarity(grey, bluish));
}

TEST(StructuralSimilarity, OnlyWindowsWithACoveredCentreCount) {
  Picture a = random_picture(40, 11, 8), b = a;
  for (std::size_t x = 0; x < 40; ++x) {
    for (std::size_t y = 0; y < 11; ++y) {
      std::uint8_t* pixel = &b.pixels[4 * (y * 40 + x)];
      if (x >= 25) pixel[0] = pixel[1] = pixel[2] = 0;
      if (x >= 15) a.pixels[4 * (y * 40 + x) + 3] = pixel[3] = 0;
    }
  }
  EXPECT_NEAR(structural_similarity(a, b).value(), 1, 1e-12);
  a.pixels[4 * (5 * 40 + 30) + 3] = 255;
  EXPECT_LT(structural_similarity(a, b), 0.95);
}

TEST(StructuralSimilarity, WithoutACoveredWindowThereIsNoFigure) {
  Picture empty = random_picture(20, 20, 9);
  for (std::size_t at = 3; at < empty.pixels.size(); at += 4)
    empty.pixels[at] = 0;
  EXPECT_FALSE(structural_similarity(empty, empty).has_value());
  const Picture small = random_picture(10, 20, 10);
  EXPECT_FALSE(structural_similarity(small, small).has_value());
}

}  // namespace
}  // namespace vitrine::test
