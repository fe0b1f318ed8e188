// SPDX-License-Identifier: Apache-2.0
#include "server/cli/processing_options.h"

#include <gtest/gtest.h>

namespace vitrine::cli {
namespace {

constexpr Flag kProcessingFlags[] = {kStripeFlag, kSamplingFlag, kLengthFlag, kLargestAngleFlag,
                                     kLargestHoleFlag};
using Words = std::vector<std::string_view>;

tl::expected<Processing, Fault> options(const Words& words, const Processing& otherwise = {}) {
  return processing_options(*Arguments::parse(words, kProcessingFlags, {}), otherwise);
}

TEST(ProcessingOptions, each_method_has_its_name) {
  const std::pair<std::string_view, StripeMethod> stripes[] = {
      {"derivative-of-gaussian", StripeMethod::kDerivativeOfGaussian},
      {"centre-of-mass", StripeMethod::kCentreOfMass},
      {"blais-rioux", StripeMethod::kBlaisRioux}};
  for (const auto& [name, method] : stripes)
    EXPECT_EQ(options({"--stripe", name})->stripe.method, method);
  const std::pair<std::string_view, SamplingMethod> samplings[] = {
      {"equidistant", SamplingMethod::kEquidistant},
      {"paper", SamplingMethod::kPaper},
      {"adaptive", SamplingMethod::kAdaptive}};
  for (const auto& [name, method] : samplings)
    EXPECT_EQ(options({"--sampling", name})->sampling.method, method);
}

TEST(ProcessingOptions, numbers_are_taken_within_their_bounds) {
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

TEST(ProcessingOptions, what_is_not_given_stays) {
  const Processing scan{.stripe = {.method = StripeMethod::kBlaisRioux, .width = 1},
                        .sampling = {.method = SamplingMethod::kPaper, .window = 20},
                        .surface = {.largest_spacing = 1, .largest_angle = 70, .largest_hole = 3}};
  const auto same = options({}, scan);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->stripe, scan.stripe);
  EXPECT_EQ(same->sampling.method, scan.sampling.method);
  EXPECT_EQ(same->sampling.window, 20);
  EXPECT_EQ(same->surface.largest_angle, 70);
  EXPECT_EQ(same->surface.largest_hole, 3);
  const auto other = options({"--stripe", "centre-of-mass"}, scan);
  EXPECT_EQ(other->stripe.method, StripeMethod::kCentreOfMass);
  EXPECT_EQ(other->stripe.width, 1);
  EXPECT_EQ(other->surface.largest_spacing, 1);
}

}  // namespace
}  // namespace vitrine::cli
