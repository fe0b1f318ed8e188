// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>
#include <new>

#include "scans_test.h"
#include "support/forwarding/catalogue_before.h"
#include "support/held_executor.h"

namespace vitrine::server {
namespace {

using test::HeldAtStep;
using Scans = ScansTest;

TEST_F(Scans, AScanEndsInADraftThatHasTheOperatorsWords) {
  const auto started = begin(order_);
  settle();
  const ScanInfo scan = info(started.scan);
  EXPECT_EQ(scan.job.record.state, JobState::kDone) << scan.job.record.error;
  EXPECT_EQ(scan.job.record.model, scan.entry.model);
  EXPECT_EQ(scan.entry.step, 12);
  EXPECT_EQ(scan.entry.points, 12 * test::kFakePoints);
  EXPECT_EQ(scan.entry.calibration, 1);
  ASSERT_TRUE(scan.entry.model);
  const auto model = installation_.catalogue->find(*scan.entry.model).value();
  ASSERT_TRUE(model);
  EXPECT_EQ(model->state, ModelState::kDraft);
  EXPECT_EQ(model->title, "A ring");
  EXPECT_EQ(model->unit, "mm");
  EXPECT_FALSE(world_.laser);
}

TEST_F(Scans, AModelThatDoesNotFitIntoTheQuotaIsNotMade) {
  quota_ = std::make_unique<Quota>(*installation_.catalogue, uploads_, 10);
  start();
  const ScanStarted started = begin(order_);
  settle();
  const JobRecord job = info(started.scan).job.record;
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_NE(job.error.find("bytes do not fit: 0 of 10 bytes are taken"), std::string::npos)
      << job.error;
  EXPECT_TRUE(installation_.catalogue->search({.includes_drafts = true}).value().models.empty());
}

TEST_F(Scans, AScanIsPublishedIfOrdered) {
  ScanOrder order = order_;
  order.is_public = true;
  order.bits = 11;
  const auto started = begin(order);
  settle();
  const ScanInfo scan = info(started.scan);
  ASSERT_TRUE(scan.entry.model) << scan.job.record.error;
  EXPECT_EQ(installation_.catalogue->find(*scan.entry.model).value()->state,
            ModelState::kPublished);
  EXPECT_TRUE(scan.entry.is_public);
}

TEST_F(Scans, PointsFrameAndProfileAreSeenWhileItScansAndPointsStay) {
  HeldAtStep held(world_, 5);
  const auto started = begin(order_);
  held.await();
  ScanInfo scan = info(started.scan);
  EXPECT_EQ(scan.job.record.stage, "scanning");
  EXPECT_EQ(scan.entry.step, 5);
  EXPECT_EQ(scan.entry.points, 5 * test::kFakePoints);
  const auto view = service_->view(scan.entry).value();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->points_from(48).size(), 2u);
  EXPECT_EQ(service_->picture(station()).value(), (acquisition::Frame{2, 1, {7, 9}}));
  held.open();
  settle();
  scan = info(started.scan);
  EXPECT_EQ(service_->view(scan.entry).value()->points(), 12 * test::kFakePoints);
}

TEST_F(Scans, WhileOneScansAnotherScanACalibrationJogAndLaserAreRefused) {
  HeldAtStep held(world_, 2);
  begin(order_);
  held.await();
  EXPECT_EQ(service_->scan(order_, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(service_->calibrate(station(), {}, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(station().jog(10).error().code, ErrorCode::kState);
  EXPECT_EQ(station().switch_laser_on([] { return true; }).error().code, ErrorCode::kState);
  EXPECT_EQ(station().status().state, ScannerState::kBusy);
  EXPECT_TRUE(station().status().scan);
  held.open();
}

TEST_F(Scans, ManualCommandsReachTheDevicesAndALostDeviceIsAProblemUntilItIsBack) {
  ASSERT_TRUE(station().jog(10));
  ASSERT_TRUE(station().switch_laser_on([] { return true; }));
  EXPECT_EQ(world_.degrees, 10);
  EXPECT_TRUE(world_.laser);
  EXPECT_EQ(service_->picture(station()).value(), (acquisition::Frame{1, 2, {3, 4}}));
  EXPECT_EQ(station().status().identity->camera.serial, "42");
  world_.reachable = false;
  EXPECT_EQ(station().jog(10).error().code, ErrorCode::kIo);
  EXPECT_EQ(station().status().state, ScannerState::kUnreachable);
  EXPECT_NE(station().status().problem.find("cable"), std::string::npos);
  world_.reachable = true;
  ASSERT_TRUE(station().jog(10));
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_EQ(station().status().problem, "");
}

TEST_F(Scans, DevicesStayOpenForTheNextCommandAndAreClosedWhenNoneComes) {
  ASSERT_TRUE(station().jog(10));
  settle();
  EXPECT_TRUE(world_.open);
  service_.reset();
  start(std::chrono::milliseconds(1));
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(station().jog(10));
    while (world_.open)
      std::this_thread::yield();
  }
}

TEST_F(Scans, AScannerThatIsLostInAJobIsUnreachableUntilItIsBack) {
  HeldAtStep held(world_, 5);
  const auto started = begin(order_);
  held.await();
  world_.reachable = false;
  held.open();
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kFailed);
  EXPECT_EQ(station().status().state, ScannerState::kUnreachable);
  settle();
  world_.reachable = true;
  static_cast<void>(station().status());  // a status request makes the service look for the scanner
  settle();
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_EQ(station().status().problem, "");
}

TEST_F(Scans, AScannerThatFailsAtACommandIsUnreachable) {
  world_.jams = true;
  EXPECT_FALSE(station().jog(10));
  EXPECT_EQ(station().status().problem, "the motor is stuck; free the table");
}

TEST_F(Scans, TheStateOfAScannerIsReportedWithoutUsingIt) {
  static_cast<void>(station().status());
  const int calls = world_.calls;
  static_cast<void>(station().status());
  EXPECT_EQ(world_.calls, calls);
}

TEST_F(Scans, APausedScanContinuesAtItsStep) {
  HeldAtStep held(world_, 4);
  const auto started = begin(order_);
  held.await();
  ASSERT_TRUE(service_->pause(info(started.scan).entry));
  held.open();
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kPaused);
  EXPECT_FALSE(world_.laser);
  EXPECT_EQ(world_.steps, 4);
  EXPECT_EQ(service_->scan(order_, {}).error().code, ErrorCode::kState);
  ASSERT_TRUE(service_->resume(info(started.scan).entry));
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(world_.steps, 12);  // every step was measured exactly once
}

TEST_F(Scans, ACancelledScanKeepsItsDataAndCanStillBecomeAModel) {
  HeldAtStep held(world_, 3);
  const auto started = begin(order_);
  held.await();
  ASSERT_TRUE(service_->jobs().cancel(started.job));
  held.open();
  settle();
  const ScanInfo scan = info(started.scan);
  EXPECT_EQ(scan.job.record.state, JobState::kCancelled);
  EXPECT_EQ(scan.entry.step, 3);
  EXPECT_EQ(service_->view(scan.entry).value()->points(), 3 * test::kFakePoints);
  EXPECT_FALSE(service_->resume(scan.entry));
  const auto reprocessed = service_->reprocess(scan.entry, order_, {});
  ASSERT_TRUE(reprocessed);
  service_->jobs().executor("").run([] {});
  const JobRecord job = (*service_->jobs().find(reprocessed->job))->record;
  EXPECT_EQ(job.kind, JobKind::kReprocess);
  EXPECT_EQ(world_.rebuilt.calibration, scan.entry.calibration) << "what is kept names it";
  EXPECT_EQ(job.state, JobState::kDone) << job.error;
  EXPECT_TRUE(info(started.scan).entry.model);
}

TEST_F(Scans, AScanIsNotReprocessedWhileItGrows) {
  HeldAtStep held(world_, 3);
  const auto started = begin(order_);
  held.await();
  EXPECT_EQ(service_->reprocess(info(started.scan).entry, order_, {}).error().code,
            ErrorCode::kState);
  held.open();
}

TEST_F(Scans, AnEmergencyStopPausesTheScanAndNothingMovesBeforeItIsResumed) {
  HeldAtStep held(world_, 6);
  const auto started = begin(order_);
  held.await();
  station().stop();
  EXPECT_TRUE(world_.stopped());
  EXPECT_FALSE(world_.laser);
  held.open();
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kPaused);
  EXPECT_EQ(info(started.scan).job.note,
            "stopped by the operator; make sure that it is safe, then resume");
  EXPECT_EQ(world_.steps, 6);
  ASSERT_TRUE(service_->resume(info(started.scan).entry));
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Scans, APictureOrARefusedCommandUndoesNoEmergencyStop) {
  HeldAtStep held(world_, 6);
  begin(order_);
  held.await();
  station().stop();
  EXPECT_FALSE(service_->scan(order_, {}));
  EXPECT_FALSE(service_->calibrate(station(), {}, {}));
  EXPECT_FALSE(station().jog(10));
  EXPECT_TRUE(world_.stopped());
  held.open();
  settle();
  EXPECT_TRUE(world_.stopped());
}

TEST_F(Scans, AStoppedScannerTakesPicturesAndStaysStopped) {
  station().stop();
  EXPECT_TRUE(station().picture());
  EXPECT_TRUE(world_.stopped());
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_TRUE(station().jog(10));
  EXPECT_FALSE(world_.stopped());
}

TEST_F(Scans, AnOrderAfterAStopDoesNotResumeTheStoppedJob) {
  settle();
  std::promise<void> opening, go_on;
  world_.while_opening = [&, first = true]() mutable {
    if (!std::exchange(first, false)) return;
    opening.set_value();
    go_on.get_future().wait();
  };
  auto jog = std::async(std::launch::async, [this] { return station().jog(10); });
  opening.get_future().wait();
  station().stop();
  begin(order_);
  go_on.set_value();
  EXPECT_FALSE(jog.get());
  EXPECT_EQ(world_.degrees, 0);
  settle();
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Scans, AnExceptionInACommandIsItsErrorAndTheDaemonContinues) {
  settle();
  world_.while_opening = [] { throw std::bad_alloc(); };
  const auto jogged = station().jog(90);
  ASSERT_FALSE(jogged);
  EXPECT_NE(jogged.error().message.find("std::bad_alloc; free memory"), std::string::npos)
      << jogged.error().message;
  EXPECT_EQ(station().status().state, ScannerState::kUnreachable)
      << "and the search for it has started again";
  settle();
  world_.while_opening = {};
  EXPECT_TRUE(station().jog(90));
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
}

TEST_F(Scans, ARestartContinuesAScan) {
  const auto started = begin_and_stop();
  EXPECT_FALSE(world_.laser);
  EXPECT_FALSE(world_.open);
  service_.reset();
  start();
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(info(started.scan).job.record.id, started.job);
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Scans, ProgressAndCalibrationAreNotLostWhenTheDaemonWasKilled) {
  const auto started = begin_and_stop();
  service_.reset();
  ScanEntry entry = *installation_.jobs->find_scan(started.scan).value();
  JobRecord job = *installation_.jobs->find_job(started.job).value();
  entry.step = 1, entry.calibration = 0,
  job.progress = 0;  // a killed daemon has not stored the progress
  ASSERT_TRUE(installation_.jobs->update(entry, {job.id, job.fence}));
  ASSERT_TRUE(installation_.jobs->update(job));
  std::promise<void> seen;
  // Holds the job before it opens the scanner.
  world_.while_opening = [until = seen.get_future().share()] { until.wait(); };
  start();
  const ScanInfo scan = info(started.scan);
  seen.set_value();
  EXPECT_EQ(scan.entry.step, 7);
  EXPECT_EQ(scan.entry.points, 7 * test::kFakePoints);
  EXPECT_EQ(scan.entry.calibration, 1);
  EXPECT_NEAR(scan.job.record.progress, 0.85 * 0.9 * 7 / 12, 1e-9);
  settle();
}

TEST_F(Scans, ProgressDoesNotGoBackWhenAFailedScanIsResumed) {
  world_.before_step = [](int step) -> std::optional<Error> {
    if (step < 6) return std::nullopt;
    return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
  };
  const auto started = begin(order_);
  settle();
  const ScanInfo failed = info(started.scan);
  test::HeldExecutor held(service_->jobs().executor(world_.name));
  ASSERT_TRUE(service_->resume(failed.entry));
  EXPECT_EQ(info(started.scan).job.record.progress, failed.job.record.progress);
  EXPECT_GT(failed.job.record.progress, 0.3);
  held.let_go();
  settle();
}

TEST_F(Scans, AModelPublishedBeforeACrashIsNotPublishedTwice) {
  const auto started = begin(order_);
  settle();
  service_.reset();
  JobRecord job = *installation_.jobs->find_job(started.job).value();
  const auto model = job.model;
  ASSERT_TRUE(model);
  job.state = JobState::kRunning;  // the stored state while a job runs, and after a crash
  job.model.reset();
  ASSERT_TRUE(installation_.jobs->update(job));
  start();
  settle();
  EXPECT_EQ(info(started.scan).entry.model, model);
  EXPECT_EQ(installation_.catalogue->search({.includes_drafts = true}).value().models.size(), 1u);
}

TEST_F(Scans, AFailedScanCanBeResumedAsANewJob) {
  world_.before_step = [](int step) -> std::optional<Error> {
    if (step < 3) return std::nullopt;
    return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
  };
  ScanOrder order = order_;
  order.webhook = "http://museum.example/";
  const auto started = begin(order);
  settle();
  ScanInfo scan = info(started.scan);
  EXPECT_EQ(scan.job.record.state, JobState::kFailed);
  EXPECT_EQ(scan.job.record.error, "camera 42 is gone; check its cable");
  EXPECT_EQ(scan.entry.step, 3);
  world_.before_step = {};
  ASSERT_TRUE(service_->resume(scan.entry));
  settle();
  scan = info(started.scan);
  EXPECT_NE(scan.entry.job, started.job);
  EXPECT_EQ(scan.job.record.state, JobState::kDone);
  EXPECT_EQ(scan.job.record.webhook, order.webhook);
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Scans, AFailedScanCanBeResumedAfterReprocessing) {
  world_.before_step = [](int step) -> std::optional<Error> {
    if (step < 3) return std::nullopt;
    return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
  };
  const auto started = begin(order_);
  settle();
  const auto reprocessed = service_->reprocess(info(started.scan).entry, order_, {});
  ASSERT_TRUE(reprocessed) << reprocessed.error().message;
  service_->jobs().executor("").run([] {});
  EXPECT_EQ((*service_->jobs().find(reprocessed->job))->record.state, JobState::kDone);
  const ScanInfo scan = info(started.scan);
  EXPECT_TRUE(scan.entry.model);
  EXPECT_EQ(scan.job.record.state, JobState::kFailed);
  EXPECT_EQ(scan.job.record.error, "camera 42 is gone; check its cable");
  world_.before_step = {};
  ASSERT_TRUE(service_->resume(scan.entry));
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_EQ(world_.steps, 12);
}

TEST_F(Scans, AScanWithoutAStepCannotBeReprocessed) {
  world_.before_step = [](int) { return Error{ErrorCode::kIo, "camera 42 is gone; plug it in"}; };
  const auto started = begin(order_);
  settle();
  EXPECT_EQ(service_->reprocess(info(started.scan).entry, order_, {}).error().code,
            ErrorCode::kState);
  EXPECT_EQ(info(started.scan).job.record.error, "camera 42 is gone; plug it in");
}

TEST_F(Scans, ACalibrationIsAJobAndItsNumberIsSeen) {
  const auto job = service_->calibrate(station(), {}, {});
  ASSERT_TRUE(job);
  settle();
  EXPECT_EQ((*service_->jobs().find(job->id))->record.state, JobState::kDone);
  EXPECT_EQ(station().status().identity->calibration, 2);
}

TEST_F(Scans, ACalibrationThatIsStoppedEndsAndFreesTheScanner) {
  HeldAtStep held(world_, 0);
  const auto job = service_->calibrate(station(), {}, {});
  ASSERT_TRUE(job);
  held.await();
  station().stop();
  held.open();
  settle();
  EXPECT_EQ((*service_->jobs().find(job->id))->record.state, JobState::kCancelled);
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_TRUE(service_->calibrate(station(), {}, {}));
}

TEST_F(Scans, ACalibrationWaitsForTheOperatorAtEachPoseAndAStopEndsIt) {
  world_.is_placed_by_hand = true;
  const auto job = service_->calibrate(station(), {.poses = 3}, {});
  ASSERT_TRUE(job);
  const auto run = service_->jobs().run(job->id);
  for (int pose = 1; pose <= 2; ++pose) {
    const std::string stage = "place the target, pose " + std::to_string(pose);
    while (run->job().stage != stage || run->job().state != JobState::kPaused)
      std::this_thread::yield();
    EXPECT_EQ(run->status().note, "so far it is seen");
    EXPECT_EQ(station().status().state, ScannerState::kBusy);
    ASSERT_TRUE(pose == 2 || service_->resume(*job));
  }
  station().stop();
  settle();
  EXPECT_EQ(run->job().state, JobState::kCancelled);
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
}

TEST_F(Scans, ADaemonThatStopsWhileACalibrationWaitsOpensNoDevice) {
  world_.is_placed_by_hand = true;
  const auto job = service_->calibrate(station(), {.poses = 3}, {});
  ASSERT_TRUE(job);
  const auto run = service_->jobs().run(job->id);
  while (run->job().state != JobState::kPaused)
    std::this_thread::yield();
  const int calls = world_.calls;
  service_->stop();
  EXPECT_EQ(world_.calls, calls);
  EXPECT_FALSE(world_.open);
  EXPECT_EQ(run->job().state, JobState::kPaused);
}

TEST_F(Scans, WhileAScanIsPausedItsScannerTakesPictures) {
  HeldAtStep held(world_, 4);
  const auto started = begin(order_);
  held.await();
  ASSERT_TRUE(service_->pause(info(started.scan).entry));
  held.open();
  settle();
  const auto picture = service_->picture(station());
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(*picture, (acquisition::Frame{1, 2, {3, 4}}));
  EXPECT_EQ(station().jog(10).error().code, ErrorCode::kState);
}

TEST_F(Scans, AModelPublishedAgainReplacesTheOneBefore) {
  ScanOrder order = order_;
  order.is_public = true;
  const auto started = begin(order);
  settle();
  const auto rebuild = [&] {
    EXPECT_TRUE(service_->reprocess(info(started.scan).entry, order, {}));
    service_->jobs().executor("").run([] {});
    return *info(started.scan).entry.model;
  };
  const auto state_of = [&](const ModelId& id) {
    return installation_.catalogue->find(id).value()->state;
  };
  const ModelId first = *info(started.scan).entry.model;
  EXPECT_EQ(rebuild(), first) << "the same bytes";
  EXPECT_EQ(state_of(first), ModelState::kPublished);
  order.bits = 11;
  const ModelId second = rebuild();
  EXPECT_EQ(state_of(first), ModelState::kDraft);
  EXPECT_EQ(state_of(second), ModelState::kPublished);
  order.bits = 10;
  order.is_public = false;
  EXPECT_EQ(rebuild(), second) << "a trial";
  EXPECT_EQ(state_of(second), ModelState::kPublished);
  order.bits = 12;
  order.is_public = true;
  const ModelId third = rebuild();
  EXPECT_EQ(state_of(second), ModelState::kDraft);
  EXPECT_EQ(state_of(third), ModelState::kPublished);
}

TEST_F(Scans, AnExceptionAfterTheModelWasAddedDoesNotFailTheJob) {
  when_added_ = [](const ModelId&) { throw std::bad_alloc(); };
  service_.reset();
  start();
  const auto started = begin(order_);
  settle();
  EXPECT_EQ(info(started.scan).job.record.state, JobState::kDone);
  EXPECT_TRUE(info(started.scan).entry.model);
}

// Calls a function immediately before it adds a model. The model's file is already stored then.
class CatalogueWithHook final : public test::CatalogueBefore {
 public:
  using CatalogueBefore::CatalogueBefore;
  Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks,
                     const std::optional<JobClaim>& by) override {
    before_adding();
    return before_.add(model, chunks, by);
  }
  std::function<void()> before_adding = [] {};
};

class RacingReprocess : public Scans {
 protected:
  RacingReprocess() {
    catalogue_ = &hooked_;
    service_.reset();
    start();
    ScanOrder order = order_;
    order.is_public = true;
    scan_ = begin(order).scan;
    settle();
    first_ = *info(scan_).entry.model;
  }
  ~RacingReprocess() override { service_.reset(); }  // before hooked_ is destroyed
  // Reprocesses the scan as the API does if a request does not say whether to publish. Runs
  // `change` after the job has stored the new file. Returns the new model.
  ModelRecord reprocess(const std::function<void()>& change) {
    hooked_.before_adding = change;
    ScanOrder order = order_;
    order.is_public_as_before = true;
    order.bits = 11;
    const auto started = service_->reprocess(info(scan_).entry, order, {});
    EXPECT_TRUE(started);
    service_->jobs().executor("").run([] {});
    const JobRecord job = (*service_->jobs().find(started->job))->record;
    EXPECT_EQ(job.state, JobState::kDone);
    EXPECT_NE(job.model, first_);
    return **hooked_.find(*job.model);
  }

  CatalogueWithHook hooked_{*installation_.catalogue};
  ScanId scan_;
  ModelId first_;
};

TEST_F(RacingReprocess, PublishesTheModelIfNothingChanges) {
  EXPECT_EQ(reprocess([] {}).state, ModelState::kPublished);
  EXPECT_EQ(hooked_.find(first_).value()->state, ModelState::kDraft);
}

TEST_F(RacingReprocess, MakesADraftIfThePreviousModelIsWithdrawnMeanwhile) {
  const ModelRecord made =
      reprocess([&] { ASSERT_TRUE(hooked_.set_state(first_, ModelState::kDraft)); });
  EXPECT_EQ(made.state, ModelState::kDraft);
  EXPECT_EQ(hooked_.find(first_).value()->state, ModelState::kDraft);
}

TEST_F(RacingReprocess, MakesADraftIfThePreviousModelIsCappedMeanwhile) {
  const ModelRecord made = reprocess([&] {
    ModelRecord capped = **hooked_.find(first_);
    capped.public_part = PublicPart{.file = capped.file, .file_bytes = capped.file_bytes};
    ASSERT_TRUE(installation_.catalogue->update(capped, std::nullopt));
  });
  EXPECT_EQ(made.state, ModelState::kDraft);
  EXPECT_EQ(hooked_.find(first_).value()->state, ModelState::kPublished);
  EXPECT_EQ(info(scan_).entry.model, first_) << "a draft does not replace it";
}

TEST_F(Scans, AJobWhoseScannerIsNotConfiguredAnyMoreSaysSo) {
  HeldAtStep held(world_, 1);
  const auto started = begin(order_);
  held.await();
  held.open();
  settle();
  service_.reset();
  JobRecord job = *installation_.jobs->find_job(started.job).value();
  job.state = JobState::kQueued;
  job.scanner = "gone";
  ASSERT_TRUE(installation_.jobs->update(job));
  start();
  service_->jobs().executor("gone").run([] {});
  EXPECT_EQ((*service_->jobs().find(started.job))->record.state, JobState::kFailed);
  EXPECT_NE((*service_->jobs().find(started.job))->record.error.find("gone"), std::string::npos);
}

}  // namespace
}  // namespace vitrine::server
