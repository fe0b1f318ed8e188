// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>

#include "scans_test.h"
#include "support/held_lane.h"

namespace vitrine {
namespace {

using test::HeldAtStep;
using Scans = ScansTest;

TEST_F(Scans, a_scan_ends_in_a_draft_that_has_the_operators_words) {
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

TEST_F(Scans, a_model_that_does_not_fit_into_the_quota_is_not_made) {
  quota_ = std::make_unique<Quota>(*installation_.catalogue, uploads_, 10);
  start();
  const ScanStarted started = begin(order_);
  settle();
  const JobRecord job = info(started.scan).job.record;
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_NE(job.error.find("bytes do not fit: 0 of 10 bytes are taken"), std::string::npos)
      << job.error;
  EXPECT_TRUE(installation_.catalogue->search({.drafts = true}).value().models.empty());
}

TEST_F(Scans, a_scan_is_published_where_that_was_ordered) {
  ScanOrder order = order_;
  order.publish = true;
  order.bits = 11;
  const auto started = begin(order);
  settle();
  const ScanInfo scan = info(started.scan);
  ASSERT_TRUE(scan.entry.model) << scan.job.record.error;
  EXPECT_EQ(installation_.catalogue->find(*scan.entry.model).value()->state,
            ModelState::kPublished);
  EXPECT_TRUE(scan.entry.is_public);
}

TEST_F(Scans, points_frame_and_profile_are_seen_while_it_scans_and_points_stay) {
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
  EXPECT_EQ(service_->picture(station()).value(), (Frame{2, 1, {7, 9}}));
  held.open();
  settle();
  scan = info(started.scan);
  EXPECT_EQ(service_->view(scan.entry).value()->points(), 12 * test::kFakePoints);
}

TEST_F(Scans, while_one_scans_another_scan_a_calibration_jog_and_laser_are_refused) {
  HeldAtStep held(world_, 2);
  begin(order_);
  held.await();
  EXPECT_EQ(service_->scan(order_, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(service_->calibrate(station(), {}, {}).error().code, ErrorCode::kState);
  EXPECT_EQ(station().jog(10).error().code, ErrorCode::kState);
  EXPECT_EQ(station().laser(true).error().code, ErrorCode::kState);
  EXPECT_EQ(station().status().state, ScannerState::kBusy);
  EXPECT_TRUE(station().status().scan);
  held.open();
}

TEST_F(Scans, commands_by_hand_reach_the_devices_and_a_lost_one_is_a_problem_until_it_is_back) {
  ASSERT_TRUE(station().jog(10));
  ASSERT_TRUE(station().laser(true));
  EXPECT_EQ(world_.degrees, 10);
  EXPECT_TRUE(world_.laser);
  EXPECT_EQ(service_->picture(station()).value(), (Frame{1, 2, {3, 4}}));
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

TEST_F(Scans, devices_stay_open_for_the_next_command_and_are_closed_when_none_comes) {
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

TEST_F(Scans, a_scanner_that_is_lost_in_a_job_is_unreachable_until_it_is_back) {
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
  static_cast<void>(station().status());  // whoever asks has it looked for
  settle();
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_EQ(station().status().problem, "");
}

TEST_F(Scans, a_scanner_that_fails_at_a_command_is_unreachable) {
  world_.jams = true;
  EXPECT_FALSE(station().jog(10));
  EXPECT_EQ(station().status().problem, "the motor is stuck; free the table");
}

TEST_F(Scans, the_state_of_a_scanner_is_told_without_using_it) {
  static_cast<void>(station().status());
  const int calls = world_.calls;
  static_cast<void>(station().status());
  EXPECT_EQ(world_.calls, calls);
}

TEST_F(Scans, a_paused_scan_goes_on_where_it_was) {
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
  EXPECT_EQ(world_.steps, 12);  // none twice
}

TEST_F(Scans, a_cancelled_scan_keeps_its_data_and_can_still_become_a_model) {
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
  service_->jobs().lane("").run([] {});
  const JobRecord job = (*service_->jobs().find(reprocessed->job))->record;
  EXPECT_EQ(job.kind, JobKind::kReprocess);
  EXPECT_EQ(world_.anew.calibration, scan.entry.calibration) << "what is kept names it";
  EXPECT_EQ(job.state, JobState::kDone) << job.error;
  EXPECT_TRUE(info(started.scan).entry.model);
}

TEST_F(Scans, a_scan_is_not_reprocessed_while_it_grows) {
  HeldAtStep held(world_, 3);
  const auto started = begin(order_);
  held.await();
  EXPECT_EQ(service_->reprocess(info(started.scan).entry, order_, {}).error().code,
            ErrorCode::kState);
  held.open();
}

TEST_F(Scans, an_emergency_stop_pauses_the_scan_and_nothing_moves_before_it_is_resumed) {
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

TEST_F(Scans, a_picture_or_a_refused_command_takes_no_emergency_stop_back) {
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

TEST_F(Scans, a_stopped_scanner_takes_pictures_and_stays_stopped) {
  station().stop();
  EXPECT_TRUE(station().picture());
  EXPECT_TRUE(world_.stopped());
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
  EXPECT_TRUE(station().jog(10));
  EXPECT_FALSE(world_.stopped());
}

TEST_F(Scans, what_is_ordered_after_a_stop_does_not_let_what_was_stopped_go_on) {
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

TEST_F(Scans, what_a_command_throws_is_its_error_and_the_daemon_goes_on) {
  settle();
  world_.while_opening = [] { throw std::bad_alloc(); };
  const auto jogged = station().jog(90);
  ASSERT_FALSE(jogged);
  EXPECT_NE(jogged.error().message.find("std::bad_alloc; free memory"), std::string::npos)
      << jogged.error().message;
  EXPECT_EQ(station().status().state, ScannerState::kUnreachable) << "and it is looked for anew";
  settle();
  world_.while_opening = {};
  EXPECT_TRUE(station().jog(90));
  EXPECT_EQ(station().status().state, ScannerState::kIdle);
}

TEST_F(Scans, what_scans_when_the_daemon_stops_goes_on_at_the_next_start) {
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

TEST_F(Scans, progress_and_calibration_are_not_lost_when_the_daemon_was_killed) {
  const auto started = begin_and_stop();
  service_.reset();
  ScanEntry entry = *installation_.jobs->find_scan(started.scan).value();
  JobRecord job = *installation_.jobs->find_job(started.job).value();
  entry.step = 1, entry.calibration = 0,
  job.progress = 0;  // the last that a daemon which is killed has stored
  ASSERT_TRUE(installation_.jobs->update(entry, {job.id, job.fence}));
  ASSERT_TRUE(installation_.jobs->update(job));
  std::promise<void> seen;
  world_.while_opening = [until = seen.get_future().share()] { until.wait(); };  // before the job
  start();
  const ScanInfo scan = info(started.scan);
  seen.set_value();
  EXPECT_EQ(scan.entry.step, 7);
  EXPECT_EQ(scan.entry.points, 7 * test::kFakePoints);
  EXPECT_EQ(scan.entry.calibration, 1);
  EXPECT_NEAR(scan.job.record.progress, 0.85 * 0.9 * 7 / 12, 1e-9);
  settle();
}

TEST_F(Scans, progress_does_not_go_back_when_a_scan_that_failed_is_gone_on_with) {
  world_.before_step = [](int step) -> std::optional<Error> {
    if (step < 6) return std::nullopt;
    return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
  };
  const auto started = begin(order_);
  settle();
  const ScanInfo failed = info(started.scan);
  test::HeldLane held(service_->jobs().lane(world_.name));
  ASSERT_TRUE(service_->resume(failed.entry));
  EXPECT_EQ(info(started.scan).job.record.progress, failed.job.record.progress);
  EXPECT_GT(failed.job.record.progress, 0.3);
  held.let_go();
  settle();
}

TEST_F(Scans, what_was_published_before_a_crash_is_not_published_twice) {
  const auto started = begin(order_);
  settle();
  service_.reset();
  JobRecord job = *installation_.jobs->find_job(started.job).value();
  const auto model = job.model;
  ASSERT_TRUE(model);
  job.state = JobState::kRunning;  // as it is stored until the end
  job.model.reset();
  ASSERT_TRUE(installation_.jobs->update(job));
  start();
  settle();
  EXPECT_EQ(info(started.scan).entry.model, model);
  EXPECT_EQ(installation_.catalogue->search({.drafts = true}).value().models.size(), 1u);
}

TEST_F(Scans, a_scan_that_failed_can_be_gone_on_with_as_a_new_job) {
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

TEST_F(Scans, a_scan_that_failed_can_be_gone_on_with_after_it_was_reprocessed) {
  world_.before_step = [](int step) -> std::optional<Error> {
    if (step < 3) return std::nullopt;
    return Error{ErrorCode::kIo, "camera 42 is gone; check its cable"};
  };
  const auto started = begin(order_);
  settle();
  const auto reprocessed = service_->reprocess(info(started.scan).entry, order_, {});
  ASSERT_TRUE(reprocessed) << reprocessed.error().message;
  service_->jobs().lane("").run([] {});
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

TEST_F(Scans, of_a_scan_without_a_step_no_model_is_made) {
  world_.before_step = [](int) { return Error{ErrorCode::kIo, "camera 42 is gone; plug it in"}; };
  const auto started = begin(order_);
  settle();
  EXPECT_EQ(service_->reprocess(info(started.scan).entry, order_, {}).error().code,
            ErrorCode::kState);
  EXPECT_EQ(info(started.scan).job.record.error, "camera 42 is gone; plug it in");
}

TEST_F(Scans, a_calibration_is_a_job_and_its_number_is_seen) {
  const auto job = service_->calibrate(station(), {}, {});
  ASSERT_TRUE(job);
  settle();
  EXPECT_EQ((*service_->jobs().find(job->id))->record.state, JobState::kDone);
  EXPECT_EQ(station().status().identity->calibration, 2);
}

TEST_F(Scans, a_calibration_that_is_stopped_ends_and_frees_the_scanner) {
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

TEST_F(Scans, a_calibration_by_hand_waits_for_each_pose_and_a_stop_ends_it) {
  world_.by_hand = true;
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

TEST_F(Scans, a_daemon_that_stops_while_a_calibration_waits_opens_no_device) {
  world_.by_hand = true;
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

TEST_F(Scans, while_a_scan_is_paused_its_scanner_takes_pictures) {
  HeldAtStep held(world_, 4);
  const auto started = begin(order_);
  held.await();
  ASSERT_TRUE(service_->pause(info(started.scan).entry));
  held.open();
  settle();
  const auto picture = service_->picture(station());
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(*picture, (Frame{1, 2, {3, 4}}));
  EXPECT_EQ(station().jog(10).error().code, ErrorCode::kState);
}

TEST_F(Scans, a_model_that_is_published_anew_takes_the_place_of_the_one_before) {
  ScanOrder order = order_;
  order.publish = true;
  const auto started = begin(order);
  settle();
  const auto anew = [&] {
    EXPECT_TRUE(service_->reprocess(info(started.scan).entry, order, {}));
    service_->jobs().lane("").run([] {});
    return *info(started.scan).entry.model;
  };
  const auto state_of = [&](const ModelId& id) {
    return installation_.catalogue->find(id).value()->state;
  };
  const ModelId first = *info(started.scan).entry.model;
  EXPECT_EQ(anew(), first) << "the same bytes";
  EXPECT_EQ(state_of(first), ModelState::kPublished);
  order.bits = 11;
  const ModelId second = anew();
  EXPECT_EQ(state_of(first), ModelState::kDraft);
  EXPECT_EQ(state_of(second), ModelState::kPublished);
  order.bits = 10;
  order.publish = false;
  EXPECT_EQ(anew(), second) << "a trial";
  EXPECT_EQ(state_of(second), ModelState::kPublished);
  order.bits = 12;
  order.publish = true;
  const ModelId third = anew();
  EXPECT_EQ(state_of(second), ModelState::kDraft);
  EXPECT_EQ(state_of(third), ModelState::kPublished);
}

TEST_F(Scans, a_job_whose_scanner_is_not_configured_any_more_says_so) {
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
  service_->jobs().lane("gone").run([] {});
  EXPECT_EQ((*service_->jobs().find(started.job))->record.state, JobState::kFailed);
  EXPECT_NE((*service_->jobs().find(started.job))->record.error.find("gone"), std::string::npos);
}

}  // namespace
}  // namespace vitrine
