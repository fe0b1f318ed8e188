// SPDX-License-Identifier: Apache-2.0
#include "server/http/admission_limit.h"

#include <gtest/gtest.h>

#include <vector>

namespace vitrine::server {
namespace {

TEST(AdmissionLimit, OneAddressHasItsShareAndLeavesTheRestToOthers) {
  const auto limit = std::make_shared<AdmissionLimit>(4, 2);
  auto first = limit->admit("a"), second = limit->admit("a");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(limit->admit("a").error(), AdmissionLimit::Refusal::kAddressFull);
  const auto third = limit->admit("b"), fourth = limit->admit("c");
  ASSERT_TRUE(third && fourth);
  EXPECT_EQ(limit->admit("d").error(), AdmissionLimit::Refusal::kFull);
  *first = nullptr;
  EXPECT_TRUE(limit->admit("a"));
  EXPECT_TRUE(limit->admit("d"));
}

}  // namespace
}  // namespace vitrine::server
