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
          .attempts = 2,
          .repairs = "1 duplicate face dropped\n2 edges split",
          .owner = "a token"};
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
          .rows = ScannedRows{.empty = .5, .saturated = .25, .doubled = .125},
          .built = sha256(std::vector<std::uint8_t>{value})};
}

class JobsSuite : public testing::Test {
 protected:
  std::unique_ptr<JobsBackend> backend_ = make_jobs_backend();
  std::unique_ptr<server::JobCatalogue> jobs_ = backend_->connect();

  void add(const JobRecord& record, const std::optional<server::ScanEntry>& of = {},
           const std::optional<server::IdempotencyKey>& key = {}) {
    const auto added = jobs_->add(record, of, key);
    ASSERT_TRUE(added) << added.error().message;
  }
};

TEST_F(JobsSuite, AJobAndItsScanAreFoundAsTheyWereAddedOverAnotherConnectionToo) {
  add(job(1), scan(100, 1));
  const auto other = backend_->connect();
  EXPECT_EQ(other->find_job(id_of(1)).value(), job(1));
  EXPECT_EQ(other->find_scan(id_of(100)).value(), scan(100, 1));
  EXPECT_EQ(other->find_job(id_of(2)).value(), std::nullopt);
  EXPECT_EQ(other->find_scan(id_of(1)).value(), std::nullopt);
}

TEST_F(JobsSuite, AnUpdateWritesOverTheWholeRecord) {
  add(job(1), scan(100, 1));
  server::JobRecord changed = job(1, JobState::kFailed);
  changed.model = id_of(7);
  changed.error = "the camera is gone";
  changed.ended = 1'700'000'001'000;
  server::ScanEntry grown = scan(100, 1);
  grown.step = 700;
  grown.model = std::nullopt;
  grown.rows = std::nullopt;
  grown.revolution = "another";
  grown.built = std::nullopt;
  ASSERT_TRUE(jobs_->update(changed));
  ASSERT_TRUE(jobs_->update(grown, {id_of(1), 0}));
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), changed);
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value(), grown);
}

TEST_F(JobsSuite, TextThatIsNotUtf8IsKeptAsFarAsPossible) {
  server::JobRecord odd = job(1);
  odd.error = std::string("before \xff\xc3 after\0", 15);
  add(odd);
  const std::string kept = jobs_->find_job(odd.id).value()->error;
  EXPECT_TRUE(kept.starts_with("before ")) << kept;
  EXPECT_NE(kept.find(" after"), std::string::npos) << kept;
}

TEST_F(JobsSuite, AnAbsentRecordCannotBeUpdated) {
  EXPECT_EQ(jobs_->update(job(1)).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->update(scan(100, 1), {id_of(1), 0}).error().code, ErrorCode::kState);
}

TEST_F(JobsSuite, ASecondJobTakesTheScanOver) {
  add(job(1), scan(100, 1));
  add(job(2), scan(100, 2));
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value()->job, id_of(2));
}

TEST_F(JobsSuite, UnfinishedJobsComeOldestFirst) {
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

TEST_F(JobsSuite, PagesComeNewestFirst) {
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

TEST_F(JobsSuite, AKeyIsTakenOnceAndARefusedJobLeavesNothing) {
  add(job(1), {}, server::IdempotencyKey{"k", Sha256{1}});
  EXPECT_EQ(jobs_->add(job(2), scan(100, 2), IdempotencyKey{"k", Sha256{2}}).error().code,
            ErrorCode::kState);
  EXPECT_EQ(jobs_->find_job(id_of(2)).value(), std::nullopt);
  EXPECT_EQ(jobs_->find_scan(id_of(100)).value(), std::nullopt);
  const auto earlier = jobs_->find_key("k").value();
  ASSERT_TRUE(earlier);
  EXPECT_EQ(earlier->job, id_of(1));
  EXPECT_EQ(earlier->request, Sha256{1});
  EXPECT_FALSE(jobs_->find_key("other").value());
}

TEST_F(JobsSuite, OldJobsAreForgottenUnlessTheyAreNamed) {
  const auto ended = [](std::uint8_t value, JobState state, std::int64_t at) {
    server::JobRecord record = job(value, state);
    record.created = record.ended = at;
    return record;
  };
  add(ended(1, JobState::kDone, 10), {}, server::IdempotencyKey{"old", Sha256{1}});
  add(ended(2, JobState::kFailed, 20), {}, IdempotencyKey{"new", Sha256{2}});
  add(ended(3, JobState::kCancelled, 10), scan(100, 3));
  add(ended(4, JobState::kPaused, 10), {}, IdempotencyKey{"continues", Sha256{4}});
  add(ended(5, JobState::kDone, 99));
  EXPECT_EQ(jobs_->forget(15, 50).value(), 1u);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), std::nullopt);
  EXPECT_FALSE(jobs_->find_key("old").value());
  EXPECT_TRUE(jobs_->find_key("new").value());
  EXPECT_TRUE(jobs_->find_key("continues").value());
  for (const auto kept : std::to_array<std::uint8_t>({2, 3, 4, 5}))
    EXPECT_TRUE(jobs_->find_job(id_of(kept)).value()) << int{kept};
  EXPECT_EQ(jobs_->forget(50, 50).value(), 1u) << "the one whose key was newer";
  EXPECT_EQ(jobs_->forget(50, 50).value(), 0u);
}

TEST_F(JobsSuite, AnIdIsTakenOnce) {
  add(job(1));
  EXPECT_EQ(jobs_->add(job(1, JobState::kDone), {}, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value()->state, JobState::kRunning);
}

TEST_F(JobsSuite, SeveralThreadsWriteAtOnce) {
  std::vector<std::thread> threads;
  for (std::uint8_t t = 0; t < 4; ++t) {
    threads.emplace_back([this, t] {
      const auto own = t % 2 == 0 ? backend_->connect() : nullptr;
      server::JobCatalogue& jobs = own ? *own : *jobs_;
      for (std::uint8_t i = 1; i <= 10; ++i)
        EXPECT_TRUE(jobs.add(job(static_cast<std::uint8_t>(t * 16 + i)), {}, {}));
    });
  }
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(jobs_->jobs({.limit = 200}).value().size(), 40u);
}

TEST_F(JobsSuite, AWebhookIsRememberedUntilItWasCalled) {
  server::JobRecord quiet = job(3, JobState::kDone);
  quiet.webhook.clear();
  add(job(4, JobState::kCancelled)), add(job(1)), add(job(2, JobState::kDone)), add(quiet);
  EXPECT_EQ(backend_->connect()->unnotified_jobs().value(),
            (std::vector{job(2, server::JobState::kDone), job(4, server::JobState::kCancelled)}));
  ASSERT_TRUE(jobs_->set_notified(id_of(2)));
  EXPECT_EQ(jobs_->unnotified_jobs().value(), std::vector{job(4, server::JobState::kCancelled)});
  ASSERT_TRUE(jobs_->update(job(2, server::JobState::kDone)));
  EXPECT_EQ(jobs_->unnotified_jobs().value().size(), 1u)
      << "a webhook that was called stays marked";
  EXPECT_EQ(jobs_->set_notified(id_of(9)).error().code, ErrorCode::kState);
}

}  // namespace
}  // namespace vitrine::test
