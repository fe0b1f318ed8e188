// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/patience.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

const Backoff kAtOnce{.pause = [](std::chrono::milliseconds) {}};

TEST(Patience, what_is_away_for_a_while_is_asked_again) {
  const JobRun run{JobRecord()};
  int calls = 0;
  const auto done = patiently(
      run,
      [&]() -> Expected<int> {
        if (++calls < 10) return fail(ErrorCode::kIo, "away");
        return calls;
      },
      kAtOnce);
  EXPECT_EQ(done.value(), 10);
}

TEST(Patience, what_is_refused_is_not_asked_again) {
  const JobRun run{JobRecord()};
  int calls = 0;
  const auto refused = patiently(
      run,
      [&]() -> Expected<void> {
        ++calls;
        return fail(ErrorCode::kState, "no");
      },
      kAtOnce);
  EXPECT_FALSE(refused);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace vitrine
