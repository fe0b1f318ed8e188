// SPDX-License-Identifier: Apache-2.0
// Daemons that share the jobs of one catalogue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "server/catalogue/sqlite_database.h"
#include "server/catalogue/sqlite_jobs.h"
#include "server/jobs/job_queue.h"
#include "support/held_lane.h"
#include "support/temporary_folder.h"

namespace vitrine {
namespace {

JobRecord upload() {
  return {.id = JobId::generate(), .kind = JobKind::kPublish, .webhook = "http://museum.example/"};
}

JobRecord scan_at(const std::string& scanner) {
  return {.id = JobId::generate(), .scanner = scanner};
}

// A daemon whose only job goes on until it is let go or something is wished of it.
class Builder {
 public:
  Builder(JobCatalogue& catalogue, const Log& events, const std::string& holder)
      : queue_(catalogue, events, [this](JobRun& run) { return work(run); },
               {.builds = true, .scans = false, .holder = holder}) {
    queue_.when_ended([this](const JobStatus& job) { told_.push_back(job.record.state); });
  }
  ~Builder() { let_go(); }

  JobQueue& queue() { return queue_; }
  // Looks for something to do, and finds it.
  void begin() {
    queue_.beat();
    begun_.get_future().wait();
  }
  void let_go() {
    const std::scoped_lock lock(mutex_);
    goes_ = true;
    changed_.notify_all();
  }
  JobWish end() { return ended_.get_future().get(); }  // what was wished of it
  void settle() {
    queue_.lane("").run([] {});
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
    const JobWish wished = run.wish();
    ended_.set_value(wished);
    return wished == JobWish::kNone ? JobEnd::kDone : JobEnd::kPutAside;
  }

  std::promise<void> begun_;
  std::promise<JobWish> ended_;
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
  // A job that the first one does.
  JobRecord begun() {
    const JobRecord job = upload();
    add(job);
    first_.begin();
    return job;
  }
  // The second one has taken it over: the first one's lease has run out.
  void take_over() {
    ASSERT_TRUE(catalogue_->drop_leases("first"));
    second_.begin();
  }
  // A daemon for scans, of a scanner that obeys at once.
  JobQueue scanning(TakenJobs taken) {
    taken.holder = "scans";
    return {*catalogue_, events_, [](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; }, taken};
  }

  // The queue has put the job aside; its lane comes to it once the answer is gone.
  static test::HeldLane put_aside(JobQueue& queue, const JobRecord& job) {
    test::HeldLane held(queue.lane(job.scanner));
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

TEST_F(SharedJobs, what_one_takes_in_another_does_and_the_first_sees_how_far_it_is) {
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
  EXPECT_EQ(first_.end(), JobWish::kNone);
  first_.settle();
  front_.beat();
  EXPECT_EQ(watched->job().state, JobState::kDone);
  EXPECT_EQ(front_.watch(job.id).value(), nullptr);
  EXPECT_EQ(front_.find(job.id).value()->record.state, JobState::kDone);
  EXPECT_EQ(first_.told(), std::vector{JobState::kDone});
}

TEST_F(SharedJobs, who_was_away_beyond_the_lease_stops_and_leaves_the_job_to_another) {
  const JobRecord job = begun();
  const auto watched = first_.queue().run(job.id);
  take_over();
  first_.queue().beat();
  EXPECT_EQ(first_.end(), JobWish::kLost);
  first_.settle();
  EXPECT_EQ(first_.queue().run(job.id), nullptr);
  EXPECT_EQ(stored(job), JobState::kRunning);
  second_.queue().beat();
  second_.let_go();
  EXPECT_EQ(second_.end(), JobWish::kNone);
  second_.settle();
  EXPECT_EQ(stored(job), JobState::kDone);
  first_.queue().beat();
  EXPECT_EQ(watched->job().state, JobState::kDone);
  EXPECT_TRUE(first_.told().empty());
  EXPECT_EQ(second_.told(), std::vector{JobState::kDone});
}

TEST_F(SharedJobs, who_watched_a_job_of_anothers_sees_it_go_on_where_it_is_taken_over) {
  const JobRecord job = begun();
  const auto watched = second_.queue().watch(job.id).value();
  take_over();
  second_.queue().beat();
  EXPECT_EQ(watched->job().state, JobState::kRunning);
  EXPECT_EQ(watched->job().attempts, 2u);
}

TEST_F(SharedJobs, an_end_that_comes_too_late_is_none) {
  const JobRecord job = begun();
  take_over();
  first_.let_go();
  EXPECT_EQ(first_.end(), JobWish::kNone);
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kRunning);
  EXPECT_EQ(first_.queue().find(job.id).value()->record.state, JobState::kRunning);
  EXPECT_TRUE(first_.told().empty());
}

TEST_F(SharedJobs, nobody_believes_a_lease_to_have_run_out_that_nobody_could_renew) {
  const JobRecord job = upload();
  add(job);
  ASSERT_TRUE(catalogue_->claim(job.id, {"holder", std::chrono::seconds(-1)}).value());
  const auto database = sqlite::open_database(folder_.path() / "catalogue.sqlite").value();
  database->lease()->run("ALTER TABLE job RENAME TO away");
  second_.queue().beat();
  database->lease()->run("ALTER TABLE away RENAME TO job");
  second_.queue().beat();
  ASSERT_EQ(second_.queue().run(job.id), nullptr);
  first_.begin();  // who knows of no such time
}

TEST_F(SharedJobs, whoever_cancels_a_job_reaches_who_does_it) {
  const JobRecord job = begun();
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kRunning);
  first_.queue().beat();
  EXPECT_EQ(first_.end(), JobWish::kCancel);
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kCancelled);
}

TEST_F(SharedJobs, what_is_cancelled_before_anybody_begins_is_never_begun) {
  const JobRecord job = upload();
  test::HeldLane held(first_.queue().lane(""));
  ASSERT_TRUE(first_.queue().add(job, {}, {}));
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kCancelled);
  held.let_go();
  first_.settle();
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_EQ(first_.queue().find(job.id).value()->record.state, JobState::kCancelled);
  EXPECT_EQ(first_.queue().run(job.id), nullptr);
}

TEST_F(SharedJobs, what_is_put_aside_can_be_cancelled_by_another) {
  const JobRecord job = scan_at("left");
  JobQueue scans = scanning({.builds = false});
  const auto held = put_aside(scans, job);
  scans.beat();
  EXPECT_TRUE(scans.job_of("left"));
  EXPECT_EQ(front_.cancel(job.id)->record.state, JobState::kCancelled);
  scans.beat();
  EXPECT_EQ(scans.job_of("left"), std::nullopt);
}

TEST_F(SharedJobs, who_comes_back_after_a_job_was_given_up_changes_nothing) {
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

TEST_F(SharedJobs, what_is_put_aside_goes_over_with_its_scanner) {
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
  first->lane("left").run([] {});
  second->beat();
  EXPECT_EQ(second->job_of("left"), std::nullopt);
  driver = "second";
  first->beat();
  second->beat();
  EXPECT_EQ(first->job_of("left"), std::nullopt);
  ASSERT_TRUE(second->job_of("left"));
  EXPECT_FALSE(second->add({.id = JobId::generate(), .scanner = "left"}, {}, {})) << "it is busy";
  ASSERT_TRUE(second->resume(job.id));
  second->lane("left").run([] {});
  EXPECT_EQ(stored(job), JobState::kDone);
}

TEST_F(SharedJobs, what_is_cancelled_while_it_is_taken_up_is_not_put_aside_again) {
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

TEST_F(SharedJobs, the_jobs_of_a_scanner_are_left_to_the_daemon_that_drives_it) {
  const JobRecord left = scan_at("left"), right = scan_at("right");
  JobQueue scans =
      scanning({.drives = [](const std::string& scanner) { return scanner == "left"; }});
  for (const JobRecord& job : {left, right})
    add(job);
  scans.beat();
  scans.lane("left").run([] {});
  EXPECT_EQ(stored(left), JobState::kDone);
  EXPECT_EQ(stored(right), JobState::kQueued);
  EXPECT_EQ(scans.run(right.id), nullptr);
}

}  // namespace
}  // namespace vitrine
