// SPDX-License-Identifier: Apache-2.0
#include "server/auth/rate_limit.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
const RateLimit::Clock::time_point kStart = RateLimit::Clock::now();

TEST(RateLimit, AllowsABurstAndThenAsMuchAsTheRate) {
  RateLimit limit(2);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(limit.take("192.0.2.1", kStart), seconds(0)) << i;
  EXPECT_EQ(limit.take("192.0.2.1", kStart), seconds(1));
  EXPECT_EQ(limit.take("192.0.2.1", kStart + milliseconds(500)), seconds(0));
  EXPECT_EQ(limit.take("192.0.2.1", kStart + milliseconds(600)), seconds(1));
  EXPECT_EQ(limit.take("192.0.2.1", kStart + milliseconds(1200)), seconds(0));
}

TEST(RateLimit, EachHasABudgetOfItsOwn) {
  RateLimit limit(1);
  for (int i = 0; i < 10; ++i)
    limit.take("192.0.2.1", kStart);
  EXPECT_GT(limit.take("192.0.2.1", kStart), seconds(0));
  int allowed = 0;  // may be below 3, because two addresses can share a budget by chance
  for (const char* other : {"192.0.2.2", "192.0.2.3", "192.0.2.4"})
    allowed += limit.take(other, kStart) == seconds(0) ? 1 : 0;
  EXPECT_GE(allowed, 2);
}

TEST(RateLimit, ARestFillsTheBudgetButNotBeyondTheBurst) {
  RateLimit limit(1);
  limit.take("192.0.2.1", kStart);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(limit.take("192.0.2.1", kStart + seconds(3600)), seconds(0)) << i;
  EXPECT_EQ(limit.take("192.0.2.1", kStart + seconds(3600)), seconds(1));
}

TEST(RateLimit, NoneIsNone) {
  RateLimit limit(0);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(limit.take("192.0.2.1", kStart), seconds(0));
}

}  // namespace
}  // namespace vitrine::server
