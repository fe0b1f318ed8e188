// SPDX-License-Identifier: Apache-2.0
#include "server/http/seats.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitrine {
namespace {

TEST(Seats, OneAddressHasItsShareAndLeavesTheRestToOthers) {
  const auto seats = std::make_shared<Seats>(4, 2);
  auto first = seats->take("a"), second = seats->take("a");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(seats->take("a").error(), Seats::Refusal::kAddressFull);
  const auto third = seats->take("b"), fourth = seats->take("c");
  ASSERT_TRUE(third && fourth);
  EXPECT_EQ(seats->take("d").error(), Seats::Refusal::kFull);
  *first = nullptr;
  EXPECT_TRUE(seats->take("a"));
  EXPECT_TRUE(seats->take("d"));
}

}  // namespace
}  // namespace vitrine
