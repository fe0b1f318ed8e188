// SPDX-License-Identifier: Apache-2.0
#include "server/messages/timestamp.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(UtcTime, IsParsedAsItIsFormatted) {
  for (const std::int64_t seconds :
       {-2'208'988'800LL, -1LL, 0LL, 951'782'400LL, 1'764'489'599LL, 253'402'300'799LL})
    EXPECT_EQ(parse_utc_time(utc_time(seconds)), seconds) << utc_time(seconds);
  EXPECT_EQ(utc_time(951'782'400), "2000-02-29T00:00:00Z");
}

TEST(UtcTime, OfAnotherFormIsRefused) {
  for (const char* wrong :
       {"", "2026-11-28", "2026-11-28T09:30:00", "2026-11-28 09:30:00Z", "2026-11-28T24:00:00Z",
        "2026-11-28T09:60:00Z", "2026-11-28T09:30:60Z", "2026-02-30T09:30:00Z",
        "2026-11-28T09:30:00.5Z", "2026-11-28T-1:30:00Z", "0000-01-01T00:00:00Z"})
    EXPECT_FALSE(parse_utc_time(wrong)) << wrong;
}

}  // namespace
}  // namespace vitrine::server
