// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/processing_options.h"

#include <gtest/gtest.h>

namespace vitrine::server::cli {
namespace {

constexpr Flag kProcessingFlags[] = {kStripeFlag, kSamplingFlag, kLengthFlag, kLargestAngleFlag,
                                     kLargestHoleFlag};
using Words = std::vector<std::string_view>;

tl::expected<acquisition::Processing, Fault> options(
    const Words& words, const acquisition::Processing& otherwise = {}) {
  return processing_options(*Arguments::parse(words, kProcessingFlags, {}), otherwise);
}

TEST(ProcessingOptions, EachMethodHasItsName) {
  const std::pair<std::string_view, acquisition::StripeMethod> stripes[] = {
      {"derivative-of-gaussian", acquisition::StripeMethod::kDerivativeOfGaussian},
      {"centre-of-mass", acquisition::StripeMethod::kCentreOfMass},
      {"blais-rioux", acquisition::StripeMethod::kBlaisRioux}};
  for (const auto& [name, method] : stripes)
    EXPECT_EQ(options({"--stripe", name})->stripe.method, method);
  const std::pair<std::string_view, acquisition::SamplingMethod> samplings[] = {
      {"equidistant", acquisition::SamplingMethod::kEquidistant},
      {"paper", acquisition::SamplingMethod::kPaper},
      {"adaptive", acquisition::SamplingMethod::kAdaptive}};
  for (const auto& [name, method] : samplings)
    EXPECT_EQ(options({"--sampling", name})->sampling.method, method);
}

TEST(ProcessingOptions, NumbersAreTakenWithinTheirBounds) {
  const auto taken = options({"--length", "15", "--largest-angle=60.5", "--largest-hole", "0"});
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->sampling.window, 15);
  EXPECT_EQ(taken->surface.largest_angle, 60.5);
  EXPECT_EQ(taken->surface.largest_hole, 0);
  for (const Words& words : {Words{"--length", "6"}, Words{"--largest-angle", "90.1"},
                             Words{"--largest-angle", "nan"}, Words{"--largest-hole", "-1"},
                             Words{"--largest-hole", "1001"}, Words{"--stripe", "gaussian"}}) {
    const auto refused = options(words);
    ASSERT_FALSE(refused) << words[1];
    EXPECT_EQ(refused.error().exit_code, 2);
  }
}

TEST(ProcessingOptions, OptionsNotGivenKeepTheirValues) {
  const acquisition::Processing scan{
      .stripe = {.method = acquisition::StripeMethod::kBlaisRioux, .width = 1},
      .sampling = {.method = acquisition::SamplingMethod::kPaper, .window = 20},
      .surface = {.largest_spacing = 1, .largest_angle = 70, .largest_hole = 3}};
  const auto same = options({}, scan);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->stripe, scan.stripe);
  EXPECT_EQ(same->sampling.method, scan.sampling.method);
  EXPECT_EQ(same->sampling.window, 20);
  EXPECT_EQ(same->surface.largest_angle, 70);
  EXPECT_EQ(same->surface.largest_hole, 3);
  const auto other = options({"--stripe", "centre-of-mass"}, scan);
  EXPECT_EQ(other->stripe.method, acquisition::StripeMethod::kCentreOfMass);
  EXPECT_EQ(other->stripe.width, 1);
  EXPECT_EQ(other->surface.largest_spacing, 1);
}

}  // namespace
}  // namespace vitrine::server::cli
