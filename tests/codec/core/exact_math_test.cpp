// SPDX-License-Identifier: Apache-2.0
#include "codec/core/exact_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrine {
namespace {

// Computes the formula of exp_of_negative() for one number. The original function takes two numbers
// at once.
double one_exp(double x) {
  const double t = std::max(x, -40.0) * 1.4426950408889634, whole = std::floor(t + 0.5);
  const double f = (t - whole) * 0.6931471805599453;
  return (1 + f * (1 + f * (1.0 / 2 +
                            f * (1.0 / 6 +
                                 f * (1.0 / 24 + f * (1.0 / 120 + f * (1.0 / 720 + f / 5040))))))) *
         std::ldexp(1.0, static_cast<int>(whole));
}

TEST(ExactMath, ExpIsCloseAndBounded) {
  for (double x = -40; x <= 0; x += 0.0037) {
    const Double2 both = exact::exp_of_negative(Double2{x, -40 - x});
    EXPECT_NEAR(both[0] / std::exp(x), 1, 1e-7) << x;
    EXPECT_EQ(both[0], one_exp(x)) << x;
    EXPECT_EQ(both[1], one_exp(-40 - x)) << x;
  }
  EXPECT_EQ(exact::exp_of_negative(both(-1e9))[0], exact::exp_of_negative(both(-40))[0]);
  EXPECT_EQ(exact::exp_of_negative(both(0))[1], 1);
}

TEST(ExactMath, FloorOfTwo) {
  for (const double x : {0.0, 0.25, 0.5, 1.0, 1.5, 2.5, 0x1p-60, 1e9 + 0.75}) {
    const Double2 lanes = exact::floor(Double2{x, -x});
    EXPECT_EQ(lanes[0], std::floor(x)) << x;
    EXPECT_EQ(lanes[1], std::floor(-x)) << x;
  }
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
