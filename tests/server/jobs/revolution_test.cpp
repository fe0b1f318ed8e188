// SPDX-License-Identifier: Apache-2.0
// Tests how a scan's folder stores the revolution of the turntable.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scans_test.h"
#include "support/held_executor.h"

namespace vitrine::server {
namespace {

class Turns : public ScansTest {
 protected:
  std::filesystem::path revolution_of(const ScanId& scan) const {
    return folder_.path() / "scans" / scan.to_string() / "turn";
  }
};

TEST_F(Turns, ARevolutionThatAnotherDaemonMeasuredIsMeasuredAgain) {
  const auto started = begin_and_stop();
  service_.reset();
  ScanEntry entry = *installation_.jobs->find_scan(started.scan).value();
  const JobRecord job = installation_.jobs->claim(started.job, {"other", {}}).value().value();
  entry.revolution = "another's";
  entry.step = 3;
  ASSERT_TRUE(installation_.jobs->update(entry, {job.id, job.fence}));
  ASSERT_TRUE(installation_.jobs->drop_leases("other"));
  start();
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(world_.steps, 7 + 12);
  entry = info(started.scan).entry;
  EXPECT_EQ(service_->view(entry).value()->points(), 12 * test::kFakePoints);
}

TEST_F(Turns, ARevolutionOfAnotherDaemonIsNotShownAsThisOnes) {
  const auto started = begin(order_);
  settle();
  ScanEntry entry = info(started.scan).entry;
  service_.reset();
  entry.revolution = "another's";
  start();
  EXPECT_EQ(service_->view(entry).error().code, ErrorCode::kState);
  EXPECT_EQ(service_->reprocess(entry, order_, {}).error().code, ErrorCode::kState);
}

TEST_F(Turns, AnInterruptedDeletionIsCompletedAtTheNextStart) {
  begin_and_stop();
  service_.reset();
  const auto left = folder_.path() / "scans" / ".removed-one";
  std::filesystem::create_directory(left);
  std::ofstream(left / "profiles") << "measured";
  start();
  EXPECT_FALSE(std::filesystem::exists(left));
}

TEST_F(Turns, MeasuredStepsAreKeptIfTheirRevolutionCannotBeRead) {
  const auto started = begin_and_stop();
  service_.reset();
  const auto turn = revolution_of(started.scan), aside = folder_.path() / "aside";
  std::filesystem::rename(turn, aside);
  std::filesystem::create_directory(turn);
  start();
  settle();
  const ScanInfo failed = info(started.scan);
  EXPECT_EQ(failed.job.record.state, JobState::kFailed);
  EXPECT_EQ(service_->view(failed.entry).error().code, ErrorCode::kIo);
  EXPECT_EQ(service_->reprocess(failed.entry, order_, {}).error().code, ErrorCode::kIo);
  std::filesystem::remove(turn);
  std::filesystem::rename(aside, turn);
  ASSERT_TRUE(service_->resume(failed.entry));
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Turns, ARevolutionThatAnotherDaemonMeasuresAfterTheOrderIsNotRebuilt) {
  const auto started = begin(order_);
  settle();
  test::HeldExecutor held(service_->jobs().executor(""));
  const auto again = service_->reprocess(info(started.scan).entry, order_, {});
  ASSERT_TRUE(again) << again.error().message;
  std::ofstream(revolution_of(started.scan)) << "another's";
  held.let_go();
  service_->jobs().executor("").run([] {});
  const JobRecord job = (*service_->jobs().find(again->job))->record;
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_THAT(job.error, testing::HasSubstr("another daemon measured the scan"));
}

}  // namespace
}  // namespace vitrine::server
