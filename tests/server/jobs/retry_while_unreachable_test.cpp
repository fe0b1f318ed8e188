// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/retry_while_unreachable.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

class RetryTest : public testing::Test {
 protected:
  // Retries an action that fails `failures` times with `code` and then succeeds. Returns the
  // result.
  Expected<int> ask(ErrorCode code, int failures) {
    const JobRun run{JobRecord()};
    const Backoff at_once{.pause = [](std::chrono::milliseconds) {}};
    return retry_while_unreachable(
        run,
        [&]() -> Expected<int> {
          if (++calls_ <= failures) return fail(code, "not now");
          return calls_;
        },
        at_once);
  }

  int calls_ = 0;
};

TEST_F(RetryTest, ACallIsRepeatedWhileTheServerIsUnreachable) {
  EXPECT_EQ(ask(ErrorCode::kIo, 9).value(), 10);
}

TEST_F(RetryTest, ARefusalIsNotRetried) {
  EXPECT_FALSE(ask(ErrorCode::kState, 9));
  EXPECT_EQ(calls_, 1);
}

}  // namespace
}  // namespace vitrine::server
