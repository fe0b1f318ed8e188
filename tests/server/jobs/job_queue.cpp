// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_queue.h"

#include <gtest/gtest.h>

#include <condition_variable>

#include "server/catalogue/sqlite_database.h"
#include "server/catalogue/sqlite_jobs.h"
#include "support/held_lane.h"
#include "support/temporary_folder.h"

namespace vitrine {
namespace {

JobRecord job_for(const std::string& scanner, JobKind kind = JobKind::kScan) {
  JobRecord job;
  job.id = JobId::generate();
  job.kind = kind;
  job.scanner = scanner;
  return job;
}

// Tells when a job has begun, and keeps it until it is let go or something is wished.
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
    return run.wish() == JobWish::kNone ? JobEnd::kDone : JobEnd::kPutAside;
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
  // What a lane has been given before is done on return.
  static void settle(JobQueue& queue, const std::string& scanner = "a") {
    queue.lane(scanner).run([] {});
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<JobCatalogue> catalogue_ =
      open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
  const Log events_ = Log::open("").value();
  Gate gate_;
};

TEST_F(Jobs, progress_never_goes_back) {
  JobRun run(job_for("a"));
  run.report("", 0.5);
  run.report("", 0.25);
  EXPECT_EQ(run.job().progress, 0.5);
}

TEST_F(Jobs, a_job_runs_and_what_it_tells_is_seen_and_kept) {
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

TEST_F(Jobs,
       an_end_that_the_catalogue_refuses_is_seen_all_the_same_and_kept_as_soon_as_it_answers) {
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

TEST_F(Jobs, a_scanner_takes_one_job_at_a_time_and_another_scanner_is_free) {
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

TEST_F(Jobs, a_paused_job_keeps_its_scanner_and_goes_on_where_it_is_resumed) {
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

TEST_F(Jobs, a_paused_job_says_why_until_it_is_resumed_whatever_it_told_meanwhile) {
  const auto queue = queue_of([this](JobRun& run) -> Expected<JobEnd> {
    const auto end = gate_.pass(run);
    run.report("scanning", 0.5, {}, "the camera is gone");
    const bool is_paused = run.wish() == JobWish::kPause;
    EXPECT_EQ(run.status().note, is_paused ? "stopped" : "the camera is gone");
    return end;
  });
  const JobRecord job = job_for("a"), waiting = job_for("", JobKind::kReprocess);
  test::HeldLane held(queue->lane(""));
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

TEST_F(Jobs, a_job_is_cancelled_where_it_runs_waits_or_is_paused) {
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

TEST_F(Jobs, a_job_that_fails_says_why) {
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

TEST_F(Jobs, an_error_after_a_wish_is_the_wish) {
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

TEST_F(Jobs, the_same_key_and_request_are_the_same_job_and_another_request_is_refused) {
  const auto queue = queue_of([](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; });
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, OnceKey{"key", Sha256{1}}));
  const auto again = queue->add(job_for("a"), {}, OnceKey{"key", Sha256{1}});
  ASSERT_TRUE(again) << again.error().message;  // although the scanner may be busy with it
  EXPECT_EQ(again->id, job.id);
  const auto other = queue->add(job_for("a"), {}, OnceKey{"key", Sha256{2}});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(catalogue_->jobs({}).value().size(), 1u);
}

TEST_F(Jobs, what_ran_when_the_daemon_stopped_goes_on_at_the_next_start_and_what_was_paused_waits) {
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

TEST_F(Jobs, what_ran_when_the_daemon_was_killed_goes_on_at_the_next_start) {
  JobRecord killed = job_for("a");
  killed.state = JobState::kRunning;
  ASSERT_TRUE(catalogue_->add(killed, {}, {}));
  const auto queue = queue_of([](JobRun&) -> Expected<JobEnd> { return JobEnd::kDone; });
  ASSERT_TRUE(queue->start());
  settle(*queue);
  EXPECT_EQ(stored(killed), JobState::kDone);
}

TEST_F(Jobs, what_three_daemons_have_died_at_has_failed) {
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
      EXPECT_NE(told.find("the daemon died 3 times at work on this"), std::string::npos) << told;
      EXPECT_EQ(stored(killed), JobState::kFailed);
      break;
    }
    gate_.await_beginning(static_cast<int>(died));
    JobRecord left = catalogue_->find_job(killed.id).value().value();
    EXPECT_EQ(left.attempts, died + 1);
    queue->stop();  // in order: that it does not do when it dies
    EXPECT_EQ(catalogue_->find_job(killed.id).value()->attempts, 0u);
    ASSERT_TRUE(catalogue_->update(left));
  }
}

TEST_F(Jobs, nothing_reacts_to_a_wish_once_what_would_is_gone) {
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

TEST_F(Jobs, a_job_that_was_being_paused_stays_paused_when_the_daemon_stops) {
  const JobRecord job = job_for("a");
  std::promise<void> begun, ending;
  const auto queue = queue_of([&](JobRun& run) -> Expected<JobEnd> {
    begun.set_value();
    ending.get_future().wait();
    EXPECT_EQ(run.wish(), JobWish::kPause);
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

// Of a job that waits for somebody: its task.
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

TEST_F(Jobs, a_job_that_waits_for_somebody_is_paused_and_goes_on_where_it_is) {
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

TEST_F(Jobs, a_job_that_waits_for_somebody_can_be_cancelled) {
  const auto queue = queue_of(wait_twice);
  const JobRecord job = job_for("a");
  ASSERT_TRUE(queue->add(job, {}, {}));
  await_pause(*queue, job, "first");
  ASSERT_TRUE(queue->cancel(job.id));
  settle(*queue);
  EXPECT_EQ(stored(job), JobState::kCancelled);
  EXPECT_TRUE(queue->add(job_for("a"), {}, {}));
}

TEST_F(Jobs, a_job_that_waits_for_somebody_does_so_after_the_daemon_has_stopped) {
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

TEST_F(Jobs, who_watches_a_job_sees_its_end) {
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

TEST_F(Jobs, the_list_has_the_newest_first_with_what_is_known_now) {
  const auto queue = gated();
  const JobRecord first = job_for("a"), second = job_for("b");
  ASSERT_TRUE(queue->add(first, {}, {}));
  ASSERT_TRUE(queue->add(second, {}, {}));
  const auto listed = queue->list({}).value();
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed[0].record.id, std::max(first.id, second.id));
}

TEST_F(Jobs, who_asked_to_is_told_of_every_end_once) {
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

TEST_F(Jobs, what_is_published_waits_for_no_scanner) {
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
}  // namespace vitrine
