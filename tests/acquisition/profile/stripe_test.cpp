// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "acquisition/profile/stripe_image.h"

namespace vitrine::acquisition {
namespace {

// Returns the stripe's column in row v: a slanted, bent curve with a step.
double shape(double v) {
  return 160 + 40 * std::sin(v / 45) + .1 * v + (v > 120 ? 25 : 0);
}

std::vector<StripePoint> stripe_of(const StripeImage& image, const StripeOptions& options = {}) {
  const FramePair pair = render(image);
  const auto stripe = find_stripe(pair.lit, pair.dark, options);
  EXPECT_TRUE(stripe.has_value());
  return stripe.value_or(std::vector<StripePoint>{});
}

double rms_error(const std::vector<StripePoint>& stripe,
                 const std::function<double(double)>& centre) {
  double sum = 0;
  for (const StripePoint& p : stripe)
    sum += std::pow(p.u - centre(p.row), 2);
  return std::sqrt(sum / static_cast<double>(stripe.size()));
}

double rms_error(const std::vector<StripePoint>& stripe, const StripeImage& image) {
  return rms_error(stripe, image.centre);
}

std::vector<StripePoint> with_flag(std::vector<StripePoint> stripe, int flag, bool is_set) {
  std::erase_if(stripe, [=](const StripePoint& p) { return ((p.flags & flag) != 0) != is_set; });
  return stripe;
}

using Method = testing::TestWithParam<StripeMethod>;

TEST_P(Method, FindsAStripeWithoutNoiseToAHundredthOfAPixel) {
  const StripeImage image{.centre = shape};
  const auto stripe = stripe_of(image, {.method = GetParam()});
  ASSERT_EQ(stripe.size(), 200);
  EXPECT_LT(rms_error(stripe, image), .01);
}

INSTANTIATE_TEST_SUITE_P(All, Method,
                         testing::Values(StripeMethod::kDerivativeOfGaussian,
                                         StripeMethod::kCentreOfMass, StripeMethod::kBlaisRioux));

TEST(Stripe, StaysWithinATenthOfAPixelUnderSpeckleNoiseAndAmbientLight) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const StripeImage image{.height = 1030,
                            .centre = [](double v) { return 160 + 60 * std::sin(v / 150); },
                            .peak = 120,
                            .speckle = .3,
                            .noise = 2,
                            .ambient = 40,
                            .seed = seed};
    const auto stripe = stripe_of(image);
    EXPECT_EQ(stripe.size(), 1030);
    EXPECT_LT(rms_error(stripe, image), .1);
  }
}

// The albedo changes on the stripe's flank. A change in the middle of the stripe would shift the
// results of all three methods more.
TEST(Stripe, IsMovedLessByAnAlbedoEdgeThanItsCentreOfMass) {
  const StripeImage image{.centre = [](double v) { return 155 + .005 * v; },
                          .ambient = 30,
                          .albedo = [](double u, double) { return u < 160.5 ? 1 : .4; }};
  const auto by = [&](StripeMethod method) {
    return rms_error(stripe_of(image, {.method = method, .steady_rows = 0}), image);
  };
  EXPECT_LT(by(StripeMethod::kDerivativeOfGaussian), .85 * by(StripeMethod::kCentreOfMass));
  EXPECT_LT(by(StripeMethod::kBlaisRioux), .5 * by(StripeMethod::kCentreOfMass));
}

TEST(Stripe, AStepIsNotAveragedAway) {
  StripeImage image{.centre = [](double v) { return v < 100 ? 120. : 124.; }, .noise = 1};
  const auto stripe = stripe_of(image);
  ASSERT_EQ(stripe.size(), 200);
  EXPECT_NEAR(stripe[99].u, 120, .15);
  EXPECT_NEAR(stripe[100].u, 124, .15);
}

TEST(Stripe, RowsWithoutItAreLeftOut) {
  const StripeImage image{.centre = [](double v) { return v < 50 || v > 150 ? NAN : 100 + v / 3; },
                          .noise = 2};
  const auto stripe = stripe_of(image);
  ASSERT_EQ(stripe.size(), 101);
  EXPECT_EQ(stripe.front().row, 50);
  EXPECT_EQ(stripe.back().row, 150);
}

TEST(Stripe, NoiseAloneShowsNone) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto stripe = stripe_of({.height = 1030,
                                   .centre = [](double) { return NAN; },
                                   .noise = 4,
                                   .ambient = 60,
                                   .seed = seed});
    EXPECT_LE(stripe.size(), 1);
  }
}

TEST(Stripe, SaturationIsFlaggedAndDoesNotMoveThePoint) {
  const StripeImage image{.centre = shape, .peak = 600, .noise = 2};
  const auto stripe = stripe_of(image);
  ASSERT_EQ(stripe.size(), 200);
  for (const StripePoint& p : stripe)
    EXPECT_TRUE(p.flags & kSaturated) << "row " << p.row;
  EXPECT_LT(rms_error(stripe, image), .05);
  for (const StripePoint& p : stripe_of({.centre = shape}))
    EXPECT_EQ(p.flags, 0) << "row " << p.row;
}

// In some rows, a reflection is stronger than the stripe.
TEST(Stripe, TheOneThatContinuesItsNeighboursIsTakenAndFlagged) {
  const StripeImage image{.centre = shape,
                          .peak = 120,
                          .noise = 2,
                          .second = [](double v) { return v > 60 && v < 90 ? 40 + v / 2 : NAN; },
                          .second_peak = 200};
  const auto stripe = with_flag(stripe_of(image), kSecond, false);
  ASSERT_EQ(stripe.size(), 200);
  EXPECT_LT(rms_error(stripe, image), .05);
  for (const StripePoint& p : stripe)
    EXPECT_EQ((p.flags & kDouble) != 0, p.row > 60 && p.row < 90) << "row " << p.row;
}

TEST(Stripe, TheOtherSurfaceOfARowFollowsTheFirst) {
  const StripeImage image{.centre = shape,
                          .peak = 120,
                          .noise = 2,
                          .second = [](double v) { return v > 60 && v < 90 ? 40 + v / 2 : NAN; },
                          .second_peak = 80};
  const auto stripe = stripe_of(image);
  const auto second = with_flag(stripe, kSecond, true);
  ASSERT_EQ(second.size(), 29);
  EXPECT_LT(rms_error(second, image.second), .1);
  EXPECT_TRUE(std::ranges::is_sorted(
      stripe, {}, [](const StripePoint& p) { return std::pair(p.row, (p.flags & kSecond) != 0); }));
}

TEST(Stripe, AGlintOnAFewRowsIsNoSurface) {
  const StripeImage image{.centre = shape,
                          .noise = 2,
                          .second = [](double v) { return v > 60 && v < 65 ? 40. : NAN; },
                          .second_peak = 120};
  EXPECT_EQ(stripe_of(image).size(), 200);
}

// The image is not dark between the two peaks, so both peaks belong to one unevenly lit stripe.
TEST(Stripe, AStripeThatRunsAlongTheRowsIsOneSurface) {
  const StripeImage image{.centre = [](double) { return 150.; },
                          .sigma = 3,
                          .second = [](double) { return 162.; },
                          .second_peak = 120};
  const auto stripe = stripe_of(image);
  EXPECT_EQ(stripe.size(), 200);
  EXPECT_EQ(with_flag(stripe, kDouble, true).size(), 200);
}

TEST(Stripe, FramesOfDifferentSizeAreRefused) {
  FramePair pair = render({.centre = shape});
  pair.dark = render({.width = 300, .centre = shape}).dark;
  const auto stripe = find_stripe(pair.lit, pair.dark);
  ASSERT_FALSE(stripe.has_value());
  EXPECT_THAT(stripe.error().message, testing::HasSubstr("320x200 and 300x200"));
}

TEST(Stripe, EmptyFramesHaveNone) {
  const auto stripe = find_stripe({}, {});
  ASSERT_TRUE(stripe.has_value());
  EXPECT_TRUE(stripe->empty());
}

}  // namespace
}  // namespace vitrine::acquisition
