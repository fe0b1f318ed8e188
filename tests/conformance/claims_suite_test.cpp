// SPDX-License-Identifier: Apache-2.0
// Tests how several daemons share the jobs of one catalogue by claims and leases.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "conformance/id_of.h"
#include "conformance/jobs_suite.h"

namespace vitrine::test {
namespace {

using namespace std::chrono_literals;

constexpr std::array kBuilds{JobKind::kPublish};
const Lease kLong{"long", 1h};
const Lease kOver{"over", -1s};  // a lease that has already expired

JobRecord build_job(std::uint8_t value, JobState state = JobState::kQueued) {
  return {.id = id_of(value), .kind = JobKind::kPublish, .state = state};
}

ModelRecord named_model(std::uint8_t value) {
  ModelRecord record;
  record.id = id_of(value);
  return record;
}

class Claims : public testing::Test {
 protected:
  std::unique_ptr<JobsBackend> backend_ = make_jobs_backend();
  std::unique_ptr<server::JobCatalogue> jobs_ = backend_->connect();
  std::unique_ptr<server::Catalogue> models_ = backend_->connect_models();

  void add(const JobRecord& record) { ASSERT_TRUE(jobs_->add(record, {}, {})); }
  JobRecord claim(std::uint8_t value, const Lease& lease) {
    const auto claimed = jobs_->claim(id_of(value), lease).value();
    EXPECT_TRUE(claimed);
    return claimed.value_or(JobRecord());
  }
  bool is_waiting(std::uint8_t value) {
    const auto waiting = jobs_->waiting_jobs(kBuilds, 100, true).value();
    return std::ranges::find(waiting, JobId(id_of(value)), &JobRecord::id) != waiting.end();
  }
};

TEST_F(Claims, AQueuedJobIsClaimedOnce) {
  add(build_job(1));
  const JobRecord taken = claim(1, kLong);
  EXPECT_EQ(taken.state, JobState::kRunning);
  EXPECT_EQ(taken.fence, 1u);
  EXPECT_EQ(taken.attempts, 1u);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), taken);
  EXPECT_EQ(backend_->connect()->claim(id_of(1), {"other", 1h}).value(), std::nullopt);
  EXPECT_FALSE(is_waiting(1));
}

TEST_F(Claims, OneOfManyConcurrentClaimsSucceeds) {
  for (std::uint8_t round = 1; round <= 10; ++round) {
    add(build_job(round));
    std::atomic<int> takers = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&, other = std::shared_ptr(backend_->connect())] {
        const auto claimed = other->claim(id_of(round), kLong);
        ASSERT_TRUE(claimed) << claimed.error().message;
        takers += *claimed ? 1 : 0;
      });
    }
    for (std::thread& thread : threads)
      thread.join();
    EXPECT_EQ(takers, 1);
  }
}

TEST_F(Claims, AFormerHolderCannotChangeAJobThatAnotherHasClaimed) {
  add(build_job(1));
  server::JobRecord late = claim(1, kOver);
  EXPECT_TRUE(is_waiting(1));
  const JobRecord next = claim(1, kLong);
  EXPECT_EQ(next.fence, late.fence + 1);
  EXPECT_EQ(jobs_->renew(late, 1h).error().code, ErrorCode::kState);
  late.state = JobState::kDone;
  EXPECT_EQ(jobs_->update(late).error().code, ErrorCode::kState);
  const auto added = models_->add(named_model(1), {}, server::JobClaim{late.id, late.fence});
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kState);
  EXPECT_EQ(models_->find(id_of(1)).value(), std::nullopt);
  EXPECT_EQ(jobs_->find_job(id_of(1)).value(), next);
}

TEST_F(Claims, AModelAndThatItsJobHasMadeItAreKnownAtOnce) {
  add(build_job(1));
  const JobRecord mine = claim(1, kLong);
  ASSERT_TRUE(models_->add(named_model(7), {}, server::JobClaim{mine.id, mine.fence}));
  EXPECT_TRUE(models_->find(id_of(7)).value());
  EXPECT_EQ(jobs_->find_job(id_of(1)).value()->model, id_of(7));
  EXPECT_FALSE(models_->add(named_model(7), {}, server::JobClaim{mine.id, mine.fence}))
      << "it exists";
}

TEST_F(Claims, OnlyTheHolderOfItsJobChangesAModel) {
  ASSERT_TRUE(models_->add(named_model(7), {}));
  add(build_job(1));
  const JobRecord late = claim(1, kOver), next = claim(1, kLong);
  server::ModelRecord changed = named_model(7);
  changed.title = "A head";
  EXPECT_FALSE(models_->update(changed, std::nullopt, server::JobClaim{late.id, late.fence}));
  EXPECT_EQ(models_->find(id_of(7)).value()->title, "");
  EXPECT_TRUE(models_->update(changed, std::nullopt, server::JobClaim{next.id, next.fence}));
  EXPECT_EQ(models_->find(id_of(7)).value()->title, "A head");
}

TEST_F(Claims, RenewingALeaseExtendsItAndStoresTheProgress) {
  add(build_job(1));
  server::JobRecord mine = claim(1, kOver);
  mine.stage = "building";
  mine.progress = 0.5;
  EXPECT_FALSE(jobs_->renew(mine, 1h).value());
  EXPECT_FALSE(is_waiting(1));
  EXPECT_EQ(backend_->connect()->find_job(id_of(1)).value(), mine);
}

TEST_F(Claims, OverdueJobsCanBeLeftOut) {
  for (const std::uint8_t value : std::array<std::uint8_t, 3>{1, 2, 3})
    add(build_job(value));
  claim(2, {"dead", 1h});
  ASSERT_TRUE(jobs_->drop_leases("dead"));
  claim(3, kOver);
  const auto left = jobs_->waiting_jobs(kBuilds, 100, false).value();
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].id, id_of(1));
  EXPECT_EQ(left[1].id, id_of(2));
}

TEST_F(Claims, WaitingJobsComeInTurnsOfTheirOwners) {
  const auto add_for = [&](const std::string& owner, std::uint8_t first, std::uint8_t last) {
    for (std::uint8_t value = first; value <= last; ++value) {
      server::JobRecord job = build_job(value);
      job.owner = owner;
      add(job);
    }
  };
  const auto next = [&](std::uint32_t limit) {
    std::vector<JobId> ids;
    const auto waiting = jobs_->waiting_jobs(kBuilds, limit, false).value();
    for (const JobRecord& job : waiting)
      ids.push_back(job.id);
    return ids;
  };
  add_for("many", 1, 20);
  add_for("few", 21, 22);
  EXPECT_EQ(next(4), (std::vector<JobId>{id_of(1), id_of(21), id_of(2), id_of(22)}));
  claim(1, kLong);
  EXPECT_EQ(next(4), (std::vector<JobId>{id_of(21), id_of(2), id_of(22), id_of(3)}));
  claim(21, kLong);
  claim(2, kLong);
  EXPECT_EQ(next(2), (std::vector<JobId>{id_of(22), id_of(3)}));
}

TEST_F(Claims, OnlyTheHolderOfItsJobUpdatesAScan) {
  server::JobRecord job = build_job(1);
  job.kind = JobKind::kScan;
  server::ScanEntry scan{
      .id = id_of(7), .job = job.id, .scanner = "rig", .steps = 10, .revolution = "first"};
  ASSERT_TRUE(jobs_->add(job, scan, {}));
  const JobRecord late = claim(1, kOver), next = claim(1, kLong);
  scan.revolution = "second";
  ASSERT_TRUE(jobs_->update(scan, {next.id, next.fence}));
  ScanEntry stale = scan;
  stale.revolution = "first";
  EXPECT_EQ(jobs_->update(stale, {late.id, late.fence}).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->find_scan(scan.id).value(), scan);
}

TEST_F(Claims, AReleasedJobCanBeClaimedAtOnce) {
  add(build_job(1));
  server::JobRecord mine = claim(1, kLong);
  mine.state = JobState::kQueued;
  ASSERT_TRUE(jobs_->update(mine));
  EXPECT_TRUE(is_waiting(1));
}

TEST_F(Claims, AJobThatIsNotRunningIsCancelledAtOnce) {
  for (const std::uint8_t value : std::array<std::uint8_t, 3>{1, 2, 3})
    add(build_job(value, value == 3 ? JobState::kPaused : JobState::kQueued));
  const JobRecord late = claim(2, kOver);
  for (const std::uint8_t value : std::array<std::uint8_t, 3>{1, 2, 3}) {
    const JobRecord cancelled = jobs_->cancel(id_of(value), 1'700'000'000'000).value();
    EXPECT_EQ(cancelled.state, JobState::kCancelled);
    EXPECT_EQ(cancelled.ended, 1'700'000'000'000);
    EXPECT_EQ(jobs_->find_job(id_of(value)).value(), cancelled);
    EXPECT_EQ(jobs_->cancel(id_of(value), 1).error().code, ErrorCode::kState);
    EXPECT_EQ(jobs_->claim(id_of(value), kLong).value(), std::nullopt);
  }
  EXPECT_FALSE(jobs_->update(late));
  EXPECT_EQ(jobs_->cancel(id_of(9), 1).error().code, ErrorCode::kState);
}

TEST_F(Claims, AJobWhoseModelIsStoredIsDoneIfItIsCancelledAfterItsDaemonDied) {
  JobRecord job = build_job(1);
  job.model = ModelId::generate();
  add(job);
  claim(1, kOver);
  EXPECT_EQ(jobs_->cancel(id_of(1), 1).value().state, JobState::kDone);
}

TEST_F(Claims, ARunningJobLearnsOfACancellation) {
  add(build_job(1));
  const JobRecord mine = claim(1, kLong);
  EXPECT_EQ(backend_->connect()->cancel(id_of(1), 1).value(), mine);
  EXPECT_TRUE(jobs_->renew(mine, 1h).value());
  server::JobRecord ended = mine;
  ended.state = JobState::kCancelled;
  EXPECT_TRUE(jobs_->update(ended));
}

TEST_F(Claims, ACancellationSurvivesADaemonThatDidNotLearnOfIt) {
  add(build_job(1));
  add(build_job(2));
  claim(1, {"dead", 1h});
  server::JobRecord mine = claim(2, kLong);
  for (const std::uint8_t value : std::array<std::uint8_t, 2>{1, 2})
    EXPECT_EQ(jobs_->cancel(id_of(value), 1).value().state, JobState::kRunning);
  ASSERT_TRUE(jobs_->drop_leases("dead"));
  mine.state = JobState::kQueued;  // the state that a daemon gives its jobs when the daemon stops
  ASSERT_TRUE(jobs_->update(mine));
  for (const std::uint8_t value : std::array<std::uint8_t, 2>{1, 2})
    EXPECT_TRUE(jobs_->renew(claim(value, kLong), 1h).value());
}

TEST_F(Claims, ReleasingAHoldersJobsLeavesThoseOfOthers) {
  add(build_job(1));
  add(build_job(2));
  claim(1, {"dead", 1h});
  claim(2, {"alive", 1h});
  ASSERT_TRUE(jobs_->drop_leases("dead"));
  EXPECT_TRUE(is_waiting(1));
  EXPECT_FALSE(is_waiting(2));
}

TEST_F(Claims, TheOldestQueuedJobsOfTheRequestedKindsComeFirst) {
  for (const std::uint8_t value : std::array<std::uint8_t, 3>{3, 1, 2})
    add(build_job(value));
  add(build_job(4, JobState::kPaused));
  add(build_job(5, JobState::kDone));
  server::JobRecord scan = build_job(6);
  scan.kind = JobKind::kScan;
  add(scan);
  const auto ids = [&](std::span<const JobKind> kinds, std::uint32_t limit) {
    std::vector<server::JobId> found;
    const auto waiting = jobs_->waiting_jobs(kinds, limit, true).value();
    for (const JobRecord& one : waiting)
      found.push_back(one.id);
    return found;
  };
  EXPECT_EQ(ids(kBuilds, 2), (std::vector<JobId>{id_of(1), id_of(2)}));
  EXPECT_EQ(ids(kBuilds, UINT32_MAX).size(), 3u);
  EXPECT_EQ(ids(std::array{server::JobKind::kCalibrate, server::JobKind::kScan}, 9),
            std::vector<JobId>{id_of(6)});
  EXPECT_TRUE(ids({}, 9).empty());
  const auto paused = jobs_->paused_jobs().value();
  ASSERT_EQ(paused.size(), 1u);
  EXPECT_EQ(paused.front().id, id_of(4));
}

TEST_F(Claims, AWebhookIsClaimedByOneDaemonAndByAnotherAfterItsDeath) {
  server::JobRecord ended = build_job(1, JobState::kDone);
  ended.webhook = "http://museum.example/told";
  add(ended);
  add(build_job(2, JobState::kDone));  // a job without a webhook
  EXPECT_EQ(jobs_->claim_unnotified({"teller", 1h}).value(), std::vector{ended});
  EXPECT_TRUE(backend_->connect()->claim_unnotified({"other", 1h}).value().empty());
  ASSERT_TRUE(jobs_->drop_leases("teller"));
  EXPECT_EQ(jobs_->claim_unnotified(kOver).value(), std::vector{ended});
  EXPECT_EQ(jobs_->claim_unnotified(kOver).value(), std::vector{ended});
  EXPECT_EQ(jobs_->renew_unnotified(id_of(1), {"teller", 1h}).error().code, ErrorCode::kState);
  EXPECT_TRUE(jobs_->renew_unnotified(id_of(1), {kOver.holder, 1h}));
  EXPECT_TRUE(jobs_->claim_unnotified(kOver).value().empty());
  ASSERT_TRUE(jobs_->set_notified(id_of(1)));
  EXPECT_FALSE(jobs_->renew_unnotified(id_of(1), {kOver.holder, 1h}));
  EXPECT_TRUE(jobs_->claim_unnotified(kOver).value().empty());
}

TEST_F(Claims, AScannerHasOneDriverAndGrowingEpochs) {
  EXPECT_EQ(jobs_->take_scanner("left", {"first", 1h}, "http://a:1").value(), 1u);
  EXPECT_EQ(jobs_->take_scanner("left", {"second", 1h}, "http://b:2").value(), std::nullopt);
  EXPECT_EQ(jobs_->take_scanner("left", {"first", -1s}, "http://a:1").value(), 2u) << "it restarts";
  EXPECT_EQ(jobs_->renew_scanner("left", 1, 1h).error().code, ErrorCode::kState);
  EXPECT_EQ(jobs_->take_scanner("left", {"second", 1h}, "http://b:2").value(), 3u);
  EXPECT_EQ(jobs_->renew_scanner("left", 2, 1h).error().code, ErrorCode::kState);
  EXPECT_TRUE(jobs_->renew_scanner("left", 3, 1h));
  EXPECT_EQ(jobs_->renew_scanner("right", 1, 1h).error().code, ErrorCode::kState);
}

// When a daemon starts, it takes its scanners, and then releases the jobs that it held when it last
// crashed. The second step must not release the scanners.
TEST_F(Claims, ReleasingJobsKeepsTheScanners) {
  ASSERT_TRUE(jobs_->take_scanner("left", {"first", 1h}, "").value());
  ASSERT_TRUE(jobs_->drop_leases("first"));
  EXPECT_EQ(jobs_->take_scanner("left", {"second", 1h}, "").value(), std::nullopt);
}

TEST_F(Claims, TheDriverOfAScannerIsKnownAndWhetherItsLeaseIsValid) {
  ASSERT_TRUE(jobs_->take_scanner("left", {"first", 1h}, "http://a:1").value());
  ASSERT_TRUE(jobs_->take_scanner("right", {"second", 1h}, "").value());
  ASSERT_TRUE(jobs_->drop_scanners("second"));
  const auto drivers = backend_->connect()->scanner_drivers().value();
  ASSERT_EQ(drivers.size(), 2u);
  EXPECT_EQ(drivers[0].scanner, "left");
  EXPECT_EQ(drivers[0].holder, "first");
  EXPECT_EQ(drivers[0].address, "http://a:1");
  EXPECT_TRUE(drivers[0].is_current);
  EXPECT_FALSE(drivers[1].is_current);
}

TEST_F(Claims, ProgressOfJobsDoesNotChangeTheRevision) {
  const auto before = models_->revision().value();
  add(build_job(1));
  const JobRecord mine = claim(1, kLong);
  ASSERT_TRUE(jobs_->renew(mine, 1h));
  EXPECT_EQ(models_->revision().value(), before);
  ASSERT_TRUE(models_->add(named_model(7), {}, server::JobClaim{mine.id, mine.fence}));
  EXPECT_NE(models_->revision().value(), before);
}

}  // namespace
}  // namespace vitrine::test
