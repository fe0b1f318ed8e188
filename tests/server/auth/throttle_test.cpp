// SPDX-License-Identifier: Apache-2.0
#include "server/auth/throttle.h"

#include <gtest/gtest.h>

#include <string>

namespace vitrine::server {
namespace {

using std::chrono::seconds;

class ThrottleTest : public ::testing::Test {
 protected:
  void fail_ten_times(std::string_view address) {
    for (std::uint32_t i = 0; i < Throttle::kFailures; ++i)
      EXPECT_EQ(throttle_.failed(address, start_), seconds(0));
  }
  Throttle throttle_;
  const Throttle::Clock::time_point start_{seconds(1000)};
};

TEST_F(ThrottleTest, TenFailuresAMinuteAreAllowed) {
  fail_ten_times("192.0.2.1");
  EXPECT_EQ(throttle_.failed("192.0.2.1", start_), seconds(60));
  EXPECT_EQ(throttle_.failed("192.0.2.1", start_ + std::chrono::milliseconds(59'500)), seconds(1));
  EXPECT_EQ(throttle_.failed("192.0.2.1", start_ + seconds(60)), seconds(0));
}

TEST_F(ThrottleTest, OthersAreLeftAlone) {
  fail_ten_times("192.0.2.1");
  int throttled = 0;  // may be above 0, because the hashes of two addresses can collide
  for (int i = 0; i < 100; ++i)
    throttled += throttle_.failed("2001:db8::" + std::to_string(i), start_) > seconds(0) ? 1 : 0;
  EXPECT_LE(throttled, 3);
}

TEST_F(ThrottleTest, AFloodOfAddressesFreesNobody) {
  fail_ten_times("192.0.2.1");
  for (int i = 0; i < 100'000; ++i)
    throttle_.failed(std::to_string(i), start_);
  EXPECT_GT(throttle_.failed("192.0.2.1", start_), seconds(0));
}

}  // namespace
}  // namespace vitrine::server
