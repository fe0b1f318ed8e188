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
  EXPECT_EQ(limit->admit("a").error(), AdmissionLimit::Refusal::kAddressFull);
  EXPECT_TRUE(limit->admit("d"));
}

TEST(AdmissionLimit, TheLastQuarterIsForAddressesWithoutATask) {
  const auto limit = std::make_shared<AdmissionLimit>(8, 4);
  std::vector<AdmissionLimit::Pass> taken;
  for (const char* address : {"a", "a", "a", "a", "b", "b"})
    taken.push_back(limit->admit(address).value());
  EXPECT_EQ(limit->admit("b").error(), AdmissionLimit::Refusal::kAddressFull);
  taken.push_back(limit->admit("c").value());
  taken.push_back(limit->admit("d").value());
  EXPECT_EQ(limit->admit("e").error(), AdmissionLimit::Refusal::kFull);
}

TEST(AdmissionLimit, OneAddressMayUseAllIfThatIsItsLimit) {
  const auto limit = std::make_shared<AdmissionLimit>(8, 8);
  std::vector<AdmissionLimit::Pass> taken;
  for (int i = 0; i < 8; ++i)
    taken.push_back(limit->admit("").value());
  EXPECT_EQ(limit->admit("").error(), AdmissionLimit::Refusal::kFull);
}

}  // namespace
}  // namespace vitrine::server
