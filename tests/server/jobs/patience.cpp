// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/patience.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

class PatienceTest : public testing::Test {
 protected:
  // Asks for what fails so many times in that way.
  Expected<int> ask(ErrorCode code, int failures) {
    const JobRun run{JobRecord()};
    const Backoff at_once{.pause = [](std::chrono::milliseconds) {}};
    return patiently(
        run,
        [&]() -> Expected<int> {
          if (++calls_ <= failures) return fail(code, "not now");
          return calls_;
        },
        at_once);
  }

  int calls_ = 0;
};

TEST_F(PatienceTest, what_is_away_for_a_while_is_asked_again) {
  EXPECT_EQ(ask(ErrorCode::kIo, 9).value(), 10);
}

TEST_F(PatienceTest, what_is_refused_is_not_asked_again) {
  EXPECT_FALSE(ask(ErrorCode::kState, 9));
  EXPECT_EQ(calls_, 1);
}

}  // namespace
}  // namespace vitrine
