// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_queue.h"

#include <gtest/gtest.h>

#include <condition_variable>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "support/held_executor.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

JobRecord job_for(const std::string& scanner, JobKind kind = JobKind::kScan) {
  JobRecord job;
  job.id = JobId::generate();
  job.kind = kind;
  job.scanner = scanner;
  return job;
}

// A task that reports its start, and then waits until the test releases it or a stop is requested.
class Gate {
 public:
  Expected<JobEnd> pass(JobRun& run) {
    bool asked = false;
    const Reaction reaction(run, [&] {
      const std::scoped_lock lock(mutex_);
      asked = true;
      changed_.notify_all();
    });
    {
      std::unique_lock lock(mutex_);
      ++begun_;
      changed_.notify_all();
      changed_.wait(lock, [&] { return open_ || asked; });
      open_ = false;
    }
    return run.stop_request() == StopRequest::kNone ? JobEnd::kDone : JobEnd::kPutAside;
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void await_beginning(int number = 1) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return begun_ >= number; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int begun_ = 0;
  bool open_ = false;
};

class Jobs : public testing::Test {
 protected:
  std::unique_ptr<JobQueue> queue_of(JobTask task) {
    return std::make_unique<JobQueue>(*catalogue_, events_, std::move(task));
  }
  std::unique_ptr<JobQueue> gated() {
    return queue_of([this](JobRun& run) { return gate_.pass(run); });
  }
  JobState stored(const JobRecord& job) { return catalogue_->find_job(job.id).value()->state; }
  // Waits until the executor has run all tasks posted earlier.
  static void settle(JobQueue& queue, const std::string& scanner = "a") {
    queue.executor(scanner).run([] {});
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<JobCatalogue> catalogue_ =
      open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
  const Log events_ = Log::open("").value();
  Gate gate_;
};

TEST_F(Jobs, ProgressNeverDecreases) {
  JobRun run(job_for("a"));
  run.report("", 0.5);
  run.report("", 0.25);
  EXPECT_EQ(run.job().progress, 0.5);
}

TEST_F(Jobs, AJobRunsAndItsProgressIsShownAndStored) {
  const ModelId model = ModelId::generate();
  const auto queue = queue_of([&](JobRun& run) -> Expected<JobEnd> {
    run.report("meshing", 0.5, 12.0);
    EXPECT_EQ(run.status().eta, 12.0);
    EXPECT_EQ(catalogue_->find_job(run.job().id).value()->stage, "meshing");
    run.made(model);
    return JobEnd::kDone;
  });
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  settle(*queue);
  const JobStatus ended = **queue->find(job.id);
  EXPECT_EQ(ended.record.state, JobState::kDone);
  EXPECT_EQ(ended.record.model, model);
  EXPECT_EQ(ended.record.progress, 1);
  EXPECT_GT(ended.record.ended, 0);
  EXPECT_EQ(ended.eta, std::nullopt);
}

TEST_F(Jobs, AnEndIsShownAtOnceAndStoredWhenTheCatalogueIsReachable) {
  const auto database = sqlite::open_database(folder_.path() / "catalogue.sqlite").value();
  const auto queue = gated();
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  gate_.await_beginning();
  database->lease()->run(
      "CREATE TRIGGER away BEFORE UPDATE ON job BEGIN SELECT RAISE(ABORT, 'away'); END");
  gate_.open();
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kRunning);
  EXPECT_EQ((*queue->find(job.id))->record.state, JobState::kDone);
  database->lease()->run("DROP TRIGGER away");
  EXPECT_EQ((*queue->find(job.id))->record.state, JobState::kDone);
  EXPECT_EQ(stored(job), JobState::kDone);
}

TEST_F(Jobs, AScannerTakesOneJobAtATimeAndAnotherScannerIsFree) {
  const auto queue = gated();
  const JobRecord first = job_for("a");
  ASSERT_TRUE(queue->add(first, {}, {}));
  const auto second = queue->add(job_for("a", JobKind::kCalibrate), {}, {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kState);
  EXPECT_NE(second.error().message.find(first.id.to_string()), std::string::npos);
  EXPECT_TRUE(queue->add(job_for("b"), {}, {}));
  EXPECT_TRUE(queue->add(job_for("a", JobKind::kReprocess), {}, {}));
  EXPECT_EQ(queue->job_of("a")->record.id, first.id);
  EXPECT_EQ(queue->job_of("c"), std::nullopt);
}

TEST_F(Jobs, APausedJobKeepsItsScannerAndContinuesWhenResumed) {
  const auto queue = gated();
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  gate_.await_beginning();
  EXPECT_FALSE(queue->resume(job.id));
  ASSERT_TRUE(queue->pause(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kPaused);
  EXPECT_FALSE(queue->pause(job.id));
  EXPECT_FALSE(queue->add(job_for("a"), {}, {}));
  ASSERT_TRUE(queue->resume(job.id));
  gate_.await_beginning(2);
  gate_.open();
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kDone);
  EXPECT_EQ(queue->pause(job.id).error().code, ErrorCode::kState);
}

TEST_F(Jobs, APausedJobKeepsItsReasonUntilItIsResumed) {
  const auto queue = queue_of([this](JobRun& run) -> Expected<JobEnd> {
    const auto end = gate_.pass(run);
    run.report("scanning", 0.5, {}, "the camera is gone");
    const bool is_paused = run.stop_request() == StopRequest::kPause;
    EXPECT_EQ(run.status().note, is_paused ? "stopped" : "the camera is gone");
    return end;
  });
  const JobRecord job = job_for("a"), waiting = job_for("", JobKind::kReprocess);
  test::HeldExecutor held(queue->executor(""));
  ASSERT_TRUE(queue->add(job, {}, {}));
  ASSERT_TRUE(queue->add(waiting, {}, {}));
  gate_.await_beginning();
  for (const JobRecord& one : {job, waiting})
    ASSERT_TRUE(queue->pause(one.id, "stopped"));
  settle(*queue);
  for (const JobRecord& one : {job, waiting})
    EXPECT_EQ(queue->find(one.id).value()->note, "stopped");
  held.let_go();
  ASSERT_TRUE(queue->resume(job.id));
  EXPECT_EQ(queue->find(job.id).value()->note, "");
  gate_.await_beginning(2);
  ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue);
  settle(*queue, "");
}

TEST_F(Jobs, AJobIsCancelledWhereItRunsWaitsOrIsPaused) {
  const auto queue = gated();
  const JobRecord running = job_for("", JobKind::kReprocess);
  const JobRecord waiting = job_for("", JobKind::kReprocess);
  const JobRecord paused = job_for("", JobKind::kReprocess);
  for (const JobRecord& job : {running, waiting, paused})
    ASSERT_TRUE(queue->add(job, {}, {}));
  gate_.await_beginning();
  ASSERT_TRUE(queue->pause(paused.id));
  for (const JobRecord& job : {waiting, paused, running})
    ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue, "");
  for (const JobRecord& job : {running, waiting, paused})
    EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_EQ(queue->cancel(running.id).error().code, ErrorCode::kState);
}

TEST_F(Jobs, JobsWithoutAScannerRunInTurnsOfTheirOwners) {
  std::string order;
  JobQueue queue(*catalogue_, events_, [&](JobRun& run) -> Expected<JobEnd> {
    order += run.job().owner;
    return JobEnd::kDone;
  });
  test::HeldExecutor held(queue.executor(""));
  for (const char* owner : {"a", "a", "a", "b", "a", "c"}) {
    JobRecord job = job_for("", JobKind::kPublish);
    job.owner = owner;
    ASSERT_TRUE(queue.add(job, {}, {}));
  }
  held.let_go();
  settle(queue, "");
  EXPECT_EQ(order, "abcaaa");
}

TEST_F(Jobs, AJobThatFailsSaysWhy) {
  const auto queue = queue_of([](JobRun& run) -> Expected<JobEnd> {
    if (run.job().kind == JobKind::kScan) return fail(ErrorCode::kIo, "the camera is gone");
    throw std::runtime_error("out of memory");
  });
  const JobRecord refused = job_for("a"), thrown = job_for("b", JobKind::kCalibrate);
  ASSERT_TRUE(queue->add(refused, {}, {}));
  ASSERT_TRUE(queue->add(thrown, {}, {}));
  settle(*queue);
  settle(*queue, "b");
  EXPECT_EQ(stored(refused), JobState::kFailed);
  EXPECT_EQ(catalogue_->find_job(refused.id).value()->error, "the camera is gone");
  EXPECT_EQ(catalogue_->find_job(thrown.id).value()->error, "out of memory");
}

TEST_F(Jobs, AnErrorAfterARequestIsTheRequest) {
  const auto queue = queue_of([this](JobRun& run) -> Expected<JobEnd> {
    static_cast<void>(gate_.pass(run));
    return fail(ErrorCode::kIo, "the child was killed");
  });
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  gate_.await_beginning();
  ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_EQ(catalogue_->find_job(job.id).value()->error, "");
}

TEST_F(Jobs, TheSameKeyAndRequestAreTheSameJobAndAnotherRequestIsRefused) {
  const auto queue = queue_of([](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; });
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, IdempotencyKey{"key", Sha256{1}}));
  const auto again = queue->add(job_for("a"), {}, IdempotencyKey{"key", Sha256{1}});
  // A repeated request with the same key must return the same job, even while that job keeps the
  // scanner busy.
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->id, job.id);
  const auto other = queue->add(job_for("a"), {}, IdempotencyKey{"key", Sha256{2}});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(catalogue_->jobs({}).value().size(), 1u);
}

TEST_F(Jobs, ARestartContinuesRunningJobsAndKeepsPausedOnes) {
  const JobRecord running = job_for("a"), paused = job_for("b");
  {
    const auto queue = gated();
    ASSERT_TRUE(queue->add(running, {}, {}));
    gate_.await_beginning();
    queue->stop();
    EXPECT_EQ(queue->add(job_for("c"), {}, {}).error().code, ErrorCode::kState);
  }
  ASSERT_TRUE(catalogue_->add(paused, {}, {}));
  JobRecord put_aside = paused;
  put_aside.state = JobState::kPaused;
  ASSERT_TRUE(catalogue_->update(put_aside));

  const auto queue = queue_of([](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; });
  ASSERT_TRUE(queue->start());
  settle(*queue, "a");
  settle(*queue, "b");
  EXPECT_EQ(stored(running), JobState::kDone);
  EXPECT_EQ(stored(paused), JobState::kPaused);
  ASSERT_TRUE(queue->resume(paused.id));
  settle(*queue, "b");
  EXPECT_EQ(stored(paused), JobState::kDone);
}

TEST_F(Jobs, ARestartAfterAKillContinuesRunningJobs) {
  JobRecord killed = job_for("a");
  killed.state = JobState::kRunning;
  ASSERT_TRUE(catalogue_->add(killed, {}, {}));
  const auto queue = queue_of([](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; });
  ASSERT_TRUE(queue->start());
  settle(*queue);
  EXPECT_EQ(stored(killed), JobState::kDone);
}

TEST_F(Jobs, AJobAtWhichThreeDaemonsHaveDiedFails) {
  JobRecord killed = job_for("a");
  killed.state = JobState::kRunning;
  killed.attempts = 1;
  killed.webhook = "http://museum.example/";
  ASSERT_TRUE(catalogue_->add(killed, {}, {}));
  for (std::uint32_t died = 1; died <= 3; ++died) {
    std::string told;
    const auto queue = gated();
    queue->when_ended([&](const JobStatus& job) { told = job.record.error; });
    ASSERT_TRUE(queue->start());
    if (died == 3) {
      EXPECT_NE(told.find("the daemon died 3 times while running this job"), std::string::npos)
          << told;
      EXPECT_EQ(stored(killed), JobState::kFailed);
      break;
    }
    gate_.await_beginning(static_cast<int>(died));
    JobRecord left = catalogue_->find_job(killed.id).value().value();
    EXPECT_EQ(left.attempts, died + 1);
    queue->stop();  // an orderly stop, which resets `attempts`
    EXPECT_EQ(catalogue_->find_job(killed.id).value()->attempts, 0u);
    ASSERT_TRUE(catalogue_->update(left));  // restores the state that a killed daemon would leave
  }
}

TEST_F(Jobs, AJobIsDoneIfItsModelWasStoredBeforeTheThirdDaemonDied) {
  JobRecord killed = job_for("", JobKind::kPublish);
  killed.state = JobState::kRunning;
  killed.attempts = 3;
  killed.model = ModelId::generate();
  ASSERT_TRUE(catalogue_->add(killed, {}, {}));
  const auto queue = gated();
  ASSERT_TRUE(queue->start());
  const JobRecord ended = catalogue_->find_job(killed.id).value().value();
  EXPECT_EQ(ended.state, JobState::kDone);
  EXPECT_EQ(ended.model, killed.model);
  EXPECT_EQ(ended.error, "");
  EXPECT_EQ(ended.progress, 1);
}

TEST_F(Jobs, NothingReactsToARequestOnceWhatWouldIsGone) {
  bool reacted = false;
  const auto queue = queue_of([&](JobRun& run) -> Expected<JobEnd> {
    try {
      const Reaction reaction(run, [&] { reacted = true; });
      throw std::bad_alloc();
    } catch (const std::bad_alloc&) {
    }
    return gate_.pass(run);
  });
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  gate_.await_beginning();
  ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_FALSE(reacted);
}

TEST_F(Jobs, AJobThatWasBeingPausedStaysPausedWhenTheDaemonStops) {
  const JobRecord job = job_for("a");
  std::promise<void> begun, ending;
  const auto queue = queue_of([&](JobRun& run) -> Expected<JobEnd> {
    begun.set_value();
    ending.get_future().wait();
    EXPECT_EQ(run.stop_request(), StopRequest::kPause);
    return JobEnd::kPutAside;
  });
  ASSERT_TRUE(queue->add(job, {}, {}));
  begun.get_future().wait();
  ASSERT_TRUE(queue->pause(job.id));
  std::thread stopper([&] { queue->stop(); });
  ending.set_value();
  stopper.join();
  EXPECT_EQ(stored(job), JobState::kPaused);
}

// A task that waits twice for the operator.
Expected<JobEnd> wait_twice(JobRun& run) {
  for (const char* stage : {"first", "second"}) {
    if (!run.await_resume(stage, 0.5, "so far")) return JobEnd::kPutAside;
    EXPECT_EQ(run.job().state, JobState::kRunning);
  }
  return JobEnd::kDone;
}

void await_pause(JobQueue& queue, const JobRecord& job, std::string_view stage) {
  for (const auto run = queue.run(job.id);
       run->job().state != JobState::kPaused || run->job().stage != stage;) {
    std::this_thread::yield();
  }
}

TEST_F(Jobs, AJobThatWaitsForTheOperatorIsPausedAndContinues) {
  const auto queue = queue_of(wait_twice);
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  await_pause(*queue, job, "first");
  EXPECT_EQ(stored(job), JobState::kPaused);
  EXPECT_EQ(catalogue_->find_job(job.id).value()->stage, "first");
  EXPECT_EQ(queue->find(job.id).value()->note, "so far");
  EXPECT_FALSE(queue->pause(job.id));
  EXPECT_FALSE(queue->add(job_for("a"), {}, {}));
  ASSERT_TRUE(queue->resume(job.id));
  await_pause(*queue, job, "second");
  ASSERT_TRUE(queue->resume(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kDone);
}

TEST_F(Jobs, AJobThatWaitsForTheOperatorCanBeCancelled) {
  const auto queue = queue_of(wait_twice);
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  await_pause(*queue, job, "first");
  ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_TRUE(queue->add(job_for("a"), {}, {}));
}

TEST_F(Jobs, AJobThatWaitsForTheOperatorStillWaitsAfterARestart) {
  const JobRecord job = job_for("a");
  {
    const auto queue = queue_of(wait_twice);
    ASSERT_TRUE(queue->add(job, {}, {}));
    await_pause(*queue, job, "first");
    queue->stop();
  }
  EXPECT_EQ(stored(job), JobState::kPaused);
  const auto queue = queue_of(wait_twice);
  ASSERT_TRUE(queue->start());
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kPaused);
  ASSERT_TRUE(queue->resume(job.id));
  await_pause(*queue, job, "first");
}

TEST_F(Jobs, AWatchedJobShowsItsEnd) {
  const auto queue = gated();
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  const auto run = queue->run(job.id);
  ASSERT_TRUE(run);
  gate_.await_beginning();
  gate_.open();
  settle(*queue);
  EXPECT_EQ(run->status().record.state, JobState::kDone);
  EXPECT_EQ(queue->run(job.id), nullptr);
}

TEST_F(Jobs, TheListHasTheNewestFirstWithTheirCurrentState) {
  const auto queue = gated();
  const JobRecord first = job_for("a"), second = job_for("b");
  ASSERT_TRUE(queue->add(first, {}, {}));
  ASSERT_TRUE(queue->add(second, {}, {}));
  const auto listed = queue->list({}).value();
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed[0].record.id, std::max(first.id, second.id));
}

TEST_F(Jobs, EveryEndIsReportedOnce) {
  std::vector<JobStatus> ends;
  const auto queue = queue_of([](JobRun& run) -> Expected<JobEnd> {
    if (run.job().scanner == "b") return fail(ErrorCode::kIo, "the camera is gone");
    return JobEnd::kDone;
  });
  queue->when_ended([&](const JobStatus& job) { ends.push_back(job); });
  JobRecord good = job_for("a"), bad = job_for("b");
  good.webhook = bad.webhook = "http://museum.example/";
  ASSERT_TRUE(queue->add(good, {}, {}));
  settle(*queue);
  ASSERT_TRUE(queue->add(bad, {}, {}));
  settle(*queue, "b");
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_EQ(ends[0].record.state, JobState::kDone);
  EXPECT_EQ(ends[0].record.webhook, good.webhook);
  EXPECT_EQ(ends[1].record.error, "the camera is gone");
}

TEST_F(Jobs, PublishingWaitsForNoScanner) {
  const auto queue = queue_of([this](JobRun& run) -> Expected<JobEnd> {
    if (run.job().kind == JobKind::kScan) return gate_.pass(run);
    return JobEnd::kDone;
  });
  ASSERT_TRUE(queue->add(job_for("a"), {}, {}));
  gate_.await_beginning();
  const JobRecord other = job_for("", JobKind::kPublish);
  ASSERT_TRUE(queue->add(other, {}, {}));
  settle(*queue, "");
  EXPECT_EQ(stored(other), JobState::kDone);
  gate_.open();
}

}  // namespace
}  // namespace vitrine::server
