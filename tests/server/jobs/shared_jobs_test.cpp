// SPDX-License-Identifier: Apache-2.0
// Tests how daemons share the jobs of one catalogue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "server/jobs/job_queue.h"
#include "support/held_executor.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

JobRecord upload() {
  return {.id = JobId::generate(), .kind = JobKind::kPublish, .webhook = "http://museum.example/"};
}

JobRecord scan_at(const std::string& scanner) {
  return {.id = JobId::generate(), .scanner = scanner};
}

// A daemon with one job, which runs until the test releases it or a stop is requested.
class Builder {
 public:
  Builder(JobCatalogue& catalogue, const Log& events, const std::string& holder)
      : queue_(catalogue, events, [this](JobRun& run) { return work(run); },
               {.builds = true, .scans = false, .holder = holder}) {
    queue_.when_ended([this](const JobStatus& job) { told_.push_back(job.record.state); });
  }
  ~Builder() { let_go(); }

  JobQueue& queue() { return queue_; }
  // Lets the queue look for a job, and waits until the job runs.
  void begin() {
    queue_.beat();
    begun_.get_future().wait();
  }
  void let_go() {
    const std::scoped_lock lock(mutex_);
    goes_ = true;
    changed_.notify_all();
  }
  StopRequest end() { return ended_.get_future().get(); }  // the stop request that the job received
  void settle() {
    queue_.executor("").run([] {});
  }
  const std::vector<JobState>& told() const { return told_; }

 private:
  Expected<JobEnd> work(JobRun& run) {
    const Reaction reaction(run, [this] { let_go(); });
    run.report("building", 0.5);
    begun_.set_value();
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return goes_; });
    }
    const StopRequest requested = run.stop_request();
    ended_.set_value(requested);
    return requested == StopRequest::kNone ? JobEnd::kDone : JobEnd::kPutAside;
  }

  std::promise<void> begun_;
  std::promise<StopRequest> ended_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool goes_ = false;
  std::vector<JobState> told_;
  JobQueue queue_;
};

class SharedJobs : public testing::Test {
 protected:
  JobState stored(const JobRecord& job) { return catalogue_->find_job(job.id).value()->state; }
  void add(const JobRecord& job) { ASSERT_TRUE(front_.add(job, {}, {})); }
  // Starts a job at the first daemon and returns it.
  JobRecord begun() {
    const JobRecord job = upload();
    add(job);
    first_.begin();
    return job;
  }
  // Lets the first daemon's lease expire, and the second daemon claim the job.
  void take_over() {
    ASSERT_TRUE(catalogue_->drop_leases("first"));
    second_.begin();
  }
  // Returns the job queue of a third daemon. Each of its jobs succeeds as soon as it runs.
  JobQueue scanning(TakenJobs taken) {
    taken.holder = "scans";
    return {*catalogue_, events_, [](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; }, taken};
  }

  // Adds a job and pauses it while its executor is blocked. Returns the blocked executor. The pause
  // takes effect when the caller releases the executor.
  static test::HeldExecutor put_aside(JobQueue& queue, const JobRecord& job) {
    test::HeldExecutor held(queue.executor(job.scanner));
    EXPECT_TRUE(queue.add(job, {}, {}));
    EXPECT_TRUE(queue.pause(job.id));
    return held;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<JobCatalogue> catalogue_ =
      open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
  const Log events_ = Log::open("").value();
  JobQueue front_{*catalogue_, events_, {}, {.builds = false, .scans = false, .holder = "front"}};
  Builder first_{*catalogue_, events_, "first"}, second_{*catalogue_, events_, "second"};
};

TEST_F(SharedJobs, OneDaemonAcceptsAJobThatAnotherRunsAndShowsItsProgress) {
  const JobRecord job = upload();
  add(job);
  const auto watched = front_.watch(job.id).value();
  ASSERT_TRUE(watched);
  EXPECT_EQ(watched->job().state, JobState::kQueued);
  first_.begin();
  first_.queue().beat();
  front_.beat();
  EXPECT_EQ(watched->job().state, JobState::kRunning);
  EXPECT_EQ(watched->job().stage, "building");
  EXPECT_EQ(watched->job().progress, 0.5);
  second_.queue().beat();
  EXPECT_EQ(second_.queue().run(job.id), nullptr);
  EXPECT_THAT(second_.queue().pause(job.id).error().message,
              testing::HasSubstr("is another daemon's"));
  first_.let_go();
  EXPECT_EQ(first_.end(), StopRequest::kNone);
  first_.settle();
  front_.beat();
  EXPECT_EQ(watched->job().state, JobState::kDone);
  EXPECT_EQ(front_.watch(job.id).value(), nullptr);
  EXPECT_EQ(front_.find(job.id).value()->record.state, JobState::kDone);
  EXPECT_EQ(first_.told(), std::vector{JobState::kDone});
}

TEST_F(SharedJobs, ManyJobsOfOneOwnerDoNotDelayTheJobOfAnotherOnAnyDaemon) {
  constexpr int kMany = 140;  // more jobs than a daemon claims at a time
  const auto add_for = [&](const std::string& owner) {
    JobRecord job = upload();
    job.owner = owner;
    add(job);
    return job;
  };
  for (int i = 0; i < kMany; ++i)
    add_for("many");
  first_.begin();
  const JobRecord other = add_for("few");
  second_.begin();
  EXPECT_EQ(stored(other), JobState::kRunning);
}

TEST_F(SharedJobs, ADaemonSuspendedBeyondItsLeaseLeavesTheJobToAnother) {
  const JobRecord job = begun();
  const auto watched = first_.queue().run(job.id);
  take_over();
  first_.queue().beat();
  EXPECT_EQ(first_.end(), StopRequest::kLost);
  first_.settle();
  EXPECT_EQ(first_.queue().run(job.id), nullptr);
  EXPECT_EQ(stored(job), JobState::kRunning);
  second_.queue().beat();
  second_.let_go();
  EXPECT_EQ(second_.end(), StopRequest::kNone);
  second_.settle();
  EXPECT_EQ(stored(job), JobState::kDone);
  first_.queue().beat();
  EXPECT_EQ(watched->job().state, JobState::kDone);
  EXPECT_TRUE(first_.told().empty());
  EXPECT_EQ(second_.told(), std::vector{JobState::kDone});
}

TEST_F(SharedJobs, AWatchedJobShowsThatAnotherDaemonContinuesIt) {
  const JobRecord job = begun();
  const auto watched = second_.queue().watch(job.id).value();
  take_over();
  second_.queue().beat();
  EXPECT_EQ(watched->job().state, JobState::kRunning);
  EXPECT_EQ(watched->job().attempts, 2u);
}

TEST_F(SharedJobs, AnEndThatComesTooLateIsIgnored) {
  const JobRecord job = begun();
  take_over();
  first_.let_go();
  EXPECT_EQ(first_.end(), StopRequest::kNone);
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kRunning);
  EXPECT_EQ(first_.queue().find(job.id).value()->record.state, JobState::kRunning);
  EXPECT_TRUE(first_.told().empty());
}

TEST_F(SharedJobs, ALeaseThatCouldNotBeRenewedDoesNotCountAsExpired) {
  const JobRecord job = upload();
  add(job);
  ASSERT_TRUE(catalogue_->claim(job.id, {"holder", std::chrono::seconds(-1)}).value());
  const auto database = sqlite::open_database(folder_.path() / "catalogue.sqlite").value();
  database->lease()->run("ALTER TABLE job RENAME TO away");
  second_.queue().beat();
  database->lease()->run("ALTER TABLE away RENAME TO job");
  second_.queue().beat();
  ASSERT_EQ(second_.queue().run(job.id), nullptr);
  // The first daemon has just started and has not seen the failure of the catalogue. It therefore
  // claims the job at once.
  first_.begin();
}

TEST_F(SharedJobs, ACancellationReachesTheDaemonThatRunsTheJob) {
  const JobRecord job = begun();
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kRunning);
  first_.queue().beat();
  EXPECT_EQ(first_.end(), StopRequest::kCancel);
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kCancelled);
}

TEST_F(SharedJobs, AJobCancelledBeforeItBeginsNeverRuns) {
  const JobRecord job = upload();
  test::HeldExecutor held(first_.queue().executor(""));
  ASSERT_TRUE(first_.queue().add(job, {}, {}));
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kCancelled);
  held.let_go();
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_EQ(first_.queue().find(job.id).value()->record.state, JobState::kCancelled);
  EXPECT_EQ(first_.queue().run(job.id), nullptr);
}

TEST_F(SharedJobs, APausedJobCanBeCancelledByAnotherDaemon) {
  const JobRecord job = scan_at("left");
  JobQueue scans = scanning({.builds = false});
  const auto held = put_aside(scans, job);
  scans.beat();
  EXPECT_TRUE(scans.job_of("left"));
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kCancelled);
  scans.beat();
  EXPECT_EQ(scans.job_of("left"), std::nullopt);
}

TEST_F(SharedJobs, ADaemonThatReturnsAfterItsJobWasGivenUpChangesNothing) {
  const JobRecord job = upload();
  add(job);
  JobRecord late;
  for (int death = 0; death < 3; ++death)
    late = catalogue_->claim(job.id, {"late", std::chrono::seconds(-1)}).value().value();
  first_.queue().beat();
  EXPECT_EQ(stored(job), JobState::kFailed);
  late.state = JobState::kDone;
  EXPECT_FALSE(catalogue_->update(late));
  EXPECT_EQ(stored(job), JobState::kFailed);
  EXPECT_EQ(first_.told(), std::vector{JobState::kFailed});
}

TEST_F(SharedJobs, APausedJobFollowsItsScannerToAnotherDaemon) {
  const JobRecord job = scan_at("left");
  std::string driver = "first";
  const auto queue_of = [&](const std::string& holder) {
    return std::make_unique<JobQueue>(
        *catalogue_, events_, [](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; },
        TakenJobs{.holder = holder,
                  .drives = [&driver, holder](const std::string&) { return driver == holder; }});
  };
  const auto first = queue_of("first"), second = queue_of("second");
  put_aside(*first, job);
  first->executor("left").run([] {});
  second->beat();
  EXPECT_EQ(second->job_of("left"), std::nullopt);
  driver = "second";
  first->beat();
  second->beat();
  EXPECT_EQ(first->job_of("left"), std::nullopt);
  ASSERT_TRUE(second->job_of("left"));
  EXPECT_FALSE(second->add({.id = JobId::generate(), .scanner = "left"}, {}, {})) << "it is busy";
  ASSERT_TRUE(second->resume(job.id));
  second->executor("left").run([] {});
  EXPECT_EQ(stored(job), JobState::kDone);
}

TEST_F(SharedJobs, AJobCancelledWhileItIsTakenOverStaysCancelled) {
  const JobRecord job = scan_at("left");
  {
    JobQueue scans = scanning({.builds = false});
    put_aside(scans, job);
  }
  JobQueue next = scanning({.drives = [&](const std::string&) {
    front_.cancel(job.id);
    return true;
  }});
  ASSERT_TRUE(next.start());
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_EQ(next.job_of("left"), std::nullopt);
}

TEST_F(SharedJobs, TheJobsOfAScannerAreLeftToTheDaemonThatDrivesIt) {
  const JobRecord left = scan_at("left"), right = scan_at("right");
  JobQueue scans =
      scanning({.drives = [](const std::string& scanner) { return scanner == "left"; }});
  for (const JobRecord& job : {left, right})
    add(job);
  scans.beat();
  scans.executor("left").run([] {});
  EXPECT_EQ(stored(left), JobState::kDone);
  EXPECT_EQ(stored(right), JobState::kQueued);
  EXPECT_EQ(scans.run(right.id), nullptr);
}

}  // namespace
}  // namespace vitrine::server
