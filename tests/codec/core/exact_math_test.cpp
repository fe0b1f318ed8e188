// SPDX-License-Identifier: Apache-2.0
#include "codec/core/exact_math.h"

#include <gtest/gtest.h>

#include <limits>

namespace vitrine {
namespace {

TEST(ExactMath, ExpIsCloseAndBounded) {
  for (double x = -40; x <= 40; x += 0.37)
    EXPECT_NEAR(exact::exp(x) / std::exp(x), 1, 1e-7) << x;
  EXPECT_EQ(exact::exp(-1e9), exact::exp(-40));
  EXPECT_EQ(exact::exp(1e9), exact::exp(40));
}

TEST(ExactMath, BucketsOfALogarithm) {
  EXPECT_EQ(exact::log2_bucket<0>(1.0), 0);
  EXPECT_EQ(exact::log2_bucket<0>(0.99), -1);
  EXPECT_EQ(exact::log2_bucket<1>(1.5), 1);
  EXPECT_EQ(exact::log2_bucket<2>(8.0), 12);
  EXPECT_EQ(exact::log2_bucket<2>(1.75), 3);
}

TEST(ExactMath, RoundsHalfUpAndTakesAnything) {
  EXPECT_EQ(exact::round(0.5), 1);
  EXPECT_EQ(exact::round(-0.5), 0);
  EXPECT_EQ(exact::round(-2.51), -3);
  EXPECT_EQ(exact::round(1e300), 1 << 20);
  EXPECT_EQ(exact::round(-1e300), -(1 << 20));
  EXPECT_EQ(exact::round(std::numeric_limits<double>::quiet_NaN()), -(1 << 20));
}

}  // namespace
}  // namespace vitrine
