// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/stripe_watch.h"
#include "support/product_names.h"

#include <gtest/gtest.h>

namespace vitrine::test {
namespace {

constexpr int kTurn = 80;  // steps in a revolution; the watch judges ten steps at a time

class Watched {
 public:
  // Simulates `steps` steps in which `doubled` % of the rows show two lines. Returns the number of
  // reports of the watch.
  int told(int steps, std::uint64_t doubled) {
    int told = 0;
    for (int i = 0; i < steps; ++i) {
      const StripeCount step{.frames = 1, .rows = 100, .doubled = doubled, .pixels = 1000};
      if (!watch_.add(step, ++done_)) ++told;
    }
    return told;
  }

 private:
  StripeWatch watch_{kTurn, 0};
  int done_ = 0;
};

TEST(StripeWatch, AnObjectThatHoversAboutTheLimitIsToldOnce) {
  Watched watched;
  EXPECT_EQ(watched.told(10, 60), 1);
  // Over ten steps, the share of rows with two lines is alternately below and above the limit of
  // one half.
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(watched.told(2, 0) + watched.told(2, 100), 0);
}

TEST(StripeWatch, WhatComesAgainLaterIsToldAgain) {
  Watched watched;
  EXPECT_EQ(watched.told(10, 60), 1);
  EXPECT_EQ(watched.told(20, 0), 0);
  EXPECT_EQ(watched.told(10, 100), 1);
}

}  // namespace
}  // namespace vitrine::test
