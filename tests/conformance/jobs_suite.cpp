// SPDX-License-Identifier: Apache-2.0
#include "conformance/jobs_suite.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "conformance/id_of.h"

namespace vitrine::test {
namespace {

JobRecord job(std::uint8_t value, JobState state = JobState::kRunning) {
  return {.id = id_of(value),
          .kind = JobKind::kReprocess,
          .state = state,
          .scanner = "left",
          .scan = id_of(100),
          .model = std::nullopt,
          .stage = "meshing",
          .progress = 0.25,
          .error = "",
          .parameters = R"({"title":"L'Écorché"})",
          .created = 1'700'000'000'000 + value,
          .ended = 0,
          .webhook = "https://museum.example/told",
          .attempts = 2};
}

ScanEntry scan(std::uint8_t value, std::uint8_t job) {
  return {.id = id_of(value),
          .job = id_of(job),
          .scanner = "left",
          .is_public = true,
          .title = "A skull",
          .parameters = "{}",
          .steps = 720,
          .step = 12,
          .points = 123'456'789'012,
          .calibration = 3,
          .model = id_of(9),
          .created = 1'700'000'000'000,
          .rows = ScannedRows{.empty = .5, .saturated = .25, .doubled = .125}};
}

class JobsSuite : public testing::Test {
 protected:
  std::unique_ptr<JobsBackend> backend_ = make_jobs_backend();
  std::unique_ptr<JobCatalogue> jobs_ = backend_->connect();

  void add(const JobRecord& record, const std::optional<ScanEntry>& of = {},
           const std::optional<OnceKey>& once = {}) {
    const auto added = jobs_->add(record, of, once);
    ASSERT_TRUE(added) << added.error().message;
  }
};

TEST_F(JobsSuite, a_job_and_its_scan_are_found_as_they_were_added_over_another_connection_too) {
  add(job(1), scan(100, 1));
  const auto other = backend_->connect();
  EXPECT_EQ(other->find_job(id_of(1)).value(), job(1));
  EXPECT_EQ(other->find_scan(id_of(100)).value(), scan(100, 1));
  EXPECT_EQ(other->find_job(id_of(2)).value(), std::nullopt);
  EXPECT_EQ(other->find_scan(id_of(1)).value(), std::nullopt);
}

TEST_F(JobsSuite, an_update_writes_over_the_whole_record) {
  add(job(1), scan(100, 1));
  JobRecord changed = job(1, JobState::kFailed);
  changed.model = id_of(7);
  changed.error = "the camera is gone";
  changed.ended = 1'700'000'001'000;
  ScanEntry grown = scan(100, 1);
  grown.step = 700;
  grown.model = std::nullopt;
  grown.rows = std::nullopt;
  grown.turn = "another";
  ASSERT_TRUE(jobs_->update(changed));
  ASSERT_TRUE(jobs_->update(grown, {id_of(1), 0}));
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), changed);
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value(), grown);
}

TEST_F(JobsSuite, words_that_are_no_utf8_are_kept_as_far_as_they_can_be) {
  JobRecord odd = job(1);
  odd.error = std::string("before \xff\xc3 after\0", 15);
  add(odd);
  const std::string kept = jobs_->find_job(odd.id).value()->error;
  EXPECT_TRUE(kept.starts_with("before ")) << kept;
  EXPECT_NE(kept.find(" after"), std::string::npos) << kept;
}

TEST_F(JobsSuite, what_is_not_there_cannot_be_updated) {
  EXPECT_EQ(jobs_->update(job(1)).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->update(scan(100, 1), {id_of(1), 0}).error().code, ErrorCode::kState);
}

TEST_F(JobsSuite, a_second_job_takes_the_scan_over) {
  add(job(1), scan(100, 1));
  add(job(2), scan(100, 2));
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value()->job, id_of(2));
}

TEST_F(JobsSuite, unfinished_jobs_come_oldest_first) {
  add(job(3, JobState::kPaused));
  add(job(1, JobState::kQueued));
  add(job(2, JobState::kDone));
  add(job(4, JobState::kCancelled));
  add(job(5, JobState::kFailed));
  add(job(6, JobState::kRunning));
  const auto left = jobs_->unfinished_jobs().value();
  ASSERT_EQ(left.size(), 3u);
  EXPECT_EQ(left[0].id, id_of(1));
  EXPECT_EQ(left[1].id, id_of(3));
  EXPECT_EQ(left[2].id, id_of(6));
}

TEST_F(JobsSuite, pages_come_newest_first) {
  for (std::uint8_t i = 1; i <= 5; ++i)
    add(job(i), scan(static_cast<std::uint8_t>(100 + i), i));
  const auto first = jobs_->jobs({.limit = 2}).value();
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].id, id_of(5));
  const auto second = jobs_->jobs({.after = first[1].id, .limit = 2}).value();
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[0].id, id_of(3));
  const auto scans = jobs_->scans({.after = id_of(103)}).value();
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].id, id_of(102));
}

TEST_F(JobsSuite, a_key_is_taken_once_and_a_refused_job_leaves_nothing) {
  add(job(1), {}, OnceKey{"k", Sha256{1}});
  EXPECT_EQ(jobs_->add(job(2), scan(100, 2), OnceKey{"k", Sha256{2}}).error().code,
            ErrorCode::kState);
  EXPECT_EQ(jobs_->find_job(id_of(2)).value(), std::nullopt);
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value(), std::nullopt);
  const auto earlier = jobs_->find_once("k").value();
  ASSERT_TRUE(earlier);
  EXPECT_EQ(earlier->job, id_of(1));
  EXPECT_EQ(earlier->request, Sha256{1});
  EXPECT_FALSE(jobs_->find_once("other").value());
}

TEST_F(JobsSuite, what_is_old_is_forgotten_but_for_what_is_named) {
  const auto ended = [](std::uint8_t value, JobState state, std::int64_t at) {
    JobRecord record = job(value, state);
    record.created = record.ended = at;
    return record;
  };
  add(ended(1, JobState::kDone, 10), {}, OnceKey{"old", Sha256{1}});
  add(ended(2, JobState::kFailed, 20), {}, OnceKey{"new", Sha256{2}});
  add(ended(3, JobState::kCancelled, 10), scan(100, 3));
  add(ended(4, JobState::kPaused, 10), {}, OnceKey{"goes on", Sha256{4}});
  add(ended(5, JobState::kDone, 99));
  EXPECT_EQ(jobs_->forget(15, 50).value(), 1u);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), std::nullopt);
  EXPECT_FALSE(jobs_->find_once("old").value());
  EXPECT_TRUE(jobs_->find_once("new").value());
  EXPECT_TRUE(jobs_->find_once("goes on").value());
  for (const auto kept : std::to_array<std::uint8_t>({2, 3, 4, 5}))
    EXPECT_TRUE(jobs_->find_job(id_of(kept)).value()) << int{kept};
  EXPECT_EQ(jobs_->forget(50, 50).value(), 1u) << "the one whose key was newer";
  EXPECT_EQ(jobs_->forget(50, 50).value(), 0u);
}

TEST_F(JobsSuite, an_id_is_taken_once) {
  add(job(1));
  EXPECT_EQ(jobs_->add(job(1, JobState::kDone), {}, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value()->state, JobState::kRunning);
}

TEST_F(JobsSuite, several_threads_write_at_once) {
  std::vector<std::thread> threads;
  for (std::uint8_t t = 0; t < 4; ++t) {
    threads.emplace_back([this, t] {
      const auto own = t % 2 == 0 ? backend_->connect() : nullptr;
      JobCatalogue& jobs = own ? *own : *jobs_;
      for (std::uint8_t i = 1; i <= 10; ++i)
        EXPECT_TRUE(jobs.add(job(static_cast<std::uint8_t>(t * 16 + i)), {}, {}));
    });
  }
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(jobs_->jobs({.limit = 200}).value().size(), 40u);
}

TEST_F(JobsSuite, who_is_to_be_told_of_an_end_is_remembered_until_it_was) {
  JobRecord quiet = job(3, JobState::kDone);
  quiet.webhook.clear();
  add(job(4, JobState::kCancelled)), add(job(1)), add(job(2, JobState::kDone)), add(quiet);
  EXPECT_EQ(backend_->connect()->untold_jobs().value(),
            (std::vector{job(2, JobState::kDone), job(4, JobState::kCancelled)}));
  ASSERT_TRUE(jobs_->set_told(id_of(2)));
  EXPECT_EQ(jobs_->untold_jobs().value(), std::vector{job(4, JobState::kCancelled)});
  ASSERT_TRUE(jobs_->update(job(2, JobState::kDone)));
  EXPECT_EQ(jobs_->untold_jobs().value().size(), 1u) << "what is told stays told";
  EXPECT_EQ(jobs_->set_told(id_of(9)).error().code, ErrorCode::kState);
}

}  // namespace
}  // namespace vitrine::test
