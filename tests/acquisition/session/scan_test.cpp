// SPDX-License-Identifier: Apache-2.0
// Tests the states of a scan: which calls each state allows, and the files it leaves.
#include "acquisition/session/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>

#include "acquisition/session/reprocess.h"
#include "scan_test.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(ScanTest, AnUndisturbedScanPassesThroughItsStatesAndEndsInAMesh) {
  std::vector<ScanState> seen;
  auto scan = this->scan();
  EXPECT_EQ(scan->status().state, ScanState::kIdle);
  world_.meanwhile = [&](const std::string&, int) {
    const ScanState state = scan->status().state;
    if (seen.empty() || seen.back() != state) seen.push_back(state);
  };
  EXPECT_EQ(run(*scan), ScanState::kDone);
  // `meanwhile` is called only while devices are in use. The devices are already closed when
  // meshing starts, so it sees no later state.
  EXPECT_THAT(seen, ElementsAre(ScanState::kChecking, ScanState::kScanning));
  ASSERT_TRUE(scan->surface());
  EXPECT_GT(scan->surface()->mesh.faces.size(), 50u);
  EXPECT_EQ(scan->status().steps_done, kSteps);
  EXPECT_EQ(scan->status().progress, 1);
}

TEST_F(ScanTest, TheMeshIsTheColumnThatStandsOnTheTable) {
  auto scan = this->scan("scan", {.steps = 60});
  ASSERT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
  for (const Vec3& p : scan->surface()->mesh.positions) {
    const double degrees = std::atan2(p.y, p.x) * 180 / std::numbers::pi;
    EXPECT_NEAR(std::hypot(p.x, p.y), fake_radius(-degrees), 0.2);
  }
}

TEST_F(ScanTest, ItWritesDownWhatItWas) {
  run(*scan());
  const auto record = reopened()->folder().record();
  ASSERT_TRUE(record && *record);
  EXPECT_EQ((*record)->camera, kFakeSerial);
  EXPECT_EQ((*record)->calibration, 1);
  EXPECT_EQ((*record)->board, "horus board-1");
  EXPECT_EQ((*record)->request.steps, kSteps);
  EXPECT_EQ((*record)->settings.region, (SensorRegion{0, 0, kFakeWidth, kFakeHeight}));
}

TEST_F(ScanTest, APausedScanGoesOnToTheSameMesh) {
  const std::string expected = undisturbed();
  for (int step = 1; step <= kSteps; ++step) {
    const std::string name = fmt::format("paused-{}", step);
    auto scan = this->scan(name);
    bool paused = false;
    world_.calls.clear();
    world_.meanwhile = [&](const std::string& call, int count) {
      if (call == "turn" && count == step && !std::exchange(paused, true)) {
        EXPECT_TRUE(scan->pause());
      }
    };
    ASSERT_EQ(run(*scan), ScanState::kPaused);
    expect_dark(world_);
    EXPECT_LT(scan->status().steps_done, kSteps);
    EXPECT_EQ(run(*scan), ScanState::kDone);
    EXPECT_EQ(mesh_text(*scan), expected);
  }
}

TEST_F(ScanTest, OneThatIsDestroyedWhileItRunsCanBeReopened) {
  {
    auto scan = this->scan();
    std::promise<void> begun;
    world_.meanwhile = [&](const std::string& call, int count) {
      if (call == "turn" && count == 4) begun.set_value();
    };
    ASSERT_TRUE(scan->resume());
    begun.get_future().wait();
  }
  expect_dark(world_);
  world_.meanwhile = {};
  auto scan = reopened();
  EXPECT_EQ(scan->status().state, ScanState::kPaused);
  EXPECT_GE(scan->status().steps_done, 2);
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

TEST_F(ScanTest, CancellingKeepsWhatWasMeasured) {
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 6) {
      EXPECT_TRUE(scan->cancel());
    }
  };
  EXPECT_EQ(run(*scan), ScanState::kCancelled);
  expect_dark(world_);
  EXPECT_FALSE(scan->resume());
  EXPECT_FALSE(scan->cancel());
  EXPECT_FALSE(scan->pause());
  const auto again = reopened();
  EXPECT_EQ(again->status().state, ScanState::kCancelled);
  EXPECT_EQ(again->folder().measured()->profiles.size(), 5u);
}

TEST_F(ScanTest, WhatAStateDoesNotAllowIsRefusedWithTheState) {
  auto scan = this->scan();
  EXPECT_THAT(scan->pause().error().message, HasSubstr("a scan that is idle"));
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 4) {
      EXPECT_THAT(scan->resume().error().message, HasSubstr("a scan that is scanning"));
    }
  };
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_FALSE(scan->cancel());
  EXPECT_FALSE(scan->pause());
}

TEST_F(ScanTest, AnIdleOneIsCancelledAtOnce) {
  auto scan = this->scan();
  EXPECT_TRUE(scan->cancel());
  EXPECT_EQ(scan->status().state, ScanState::kCancelled);
}

TEST_F(ScanTest, ADoneOneIsMeshedAgainWithoutTheDevices) {
  std::string mesh;
  {
    auto scan = this->scan();
    run(*scan);
    mesh = mesh_text(*scan);
  }
  world_.fault = [](const std::string&, int) { return true; };
  auto scan = reopened();
  EXPECT_EQ(scan->status().state, ScanState::kDone);
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), mesh);
}

TEST_F(ScanTest, AFolderThatHoldsAScanIsNotUsedForAnother) {
  auto first = scan();
  const auto expect_refused = [&](const char* next_step) {
    const auto second = Scan::create(scanner(), request(), path());
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::kState);
    EXPECT_THAT(second.error().message, HasSubstr(next_step));
  };
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 6) {
      EXPECT_TRUE(first->pause());
    }
  };
  EXPECT_EQ(run(*first), ScanState::kPaused);
  expect_refused("already contains a scan; resume it or remove the folder");
  EXPECT_EQ(run(*first), ScanState::kDone);
  expect_refused("contains a scan that is done; give another name, or reprocess that scan");
}

TEST_F(ScanTest, NothingIsReopenedWhereNothingIs) {
  const auto none = Scan::reopen(scanner(), path("none"));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("there is no scan in"));
}

TEST_F(ScanTest, RequestsBeyondBoundsAreRefused) {
  const auto refused = [&](ScanRequest request, const char* why) {
    const auto made = Scan::create(scanner(), request, path());
    ASSERT_FALSE(made) << why;
    EXPECT_THAT(made.error().message, HasSubstr(why));
  };
  refused({.steps = 7}, "7 steps");
  refused({.steps = 36'001}, "36001 steps");
  refused({.exposure_us = 0}, "exposure of 0");
  refused({.exposure_us = 1'000'001}, "choose up to 1000000");
  refused({.processing = {.sampling = {.window = 7}}}, "length of 7 points");
}

TEST_F(ScanTest, ProgressAndTheTimeLeftFollowTheSteps) {
  double clock = 100;
  std::mutex mutex;
  ScanSettings settings = impatient();
  settings.seconds = [&] {
    const std::lock_guard lock(mutex);
    return clock;
  };
  auto made = acquisition::Scan::create(scanner(), request(), path(), settings);
  Scan& scan = **made;
  double before = 0;
  std::optional<double> left;
  world_.meanwhile = [&](const std::string& call, int) {
    const ScanStatus status = scan.status();
    EXPECT_GE(status.progress, before);
    before = status.progress;
    if (status.seconds_left) left = status.seconds_left;
    const std::lock_guard lock(mutex);
    if (call == "turn") clock += 2;
  };
  EXPECT_EQ(run(scan), ScanState::kDone);
  EXPECT_GT(before, 0.5);
  ASSERT_TRUE(left);
  EXPECT_NEAR(*left, 2, 2);
}

TEST_F(ScanTest, WithoutACalibrationOfThisCameraAndRegionNothingBegins) {
  const auto refused = [&](const char* why) {
    auto scan = Scan::create(scanner(), request(), path());
    EXPECT_EQ(run(**scan), ScanState::kFailed);
    EXPECT_THAT((*scan)->status().error->message, HasSubstr(why));
    EXPECT_EQ(world_.calls["laser on"], 0);
    EXPECT_EQ(world_.calls["turn"], 0);
  };
  std::filesystem::remove_all(calibrations_);
  refused("there is no calibration");
  Calibration other = fake_calibration();
  other.camera = "another";
  ASSERT_TRUE(CalibrationStore(calibrations_).add(other));
  refused("is not calibrated");
  other = fake_calibration();
  other.region.x = 8;
  ASSERT_TRUE(CalibrationStore(calibrations_).add(other));
  refused("is calibrated for the region");
}

TEST_F(ScanTest, ItIsMeasuredWithTheCalibrationThatWasAskedFor) {
  Calibration newer = fake_calibration(), other = newer;
  newer.axis.a += 1, other.camera = "fake-2";
  ASSERT_EQ(acquisition::CalibrationStore(calibrations_).add(newer)->number, 2);
  ASSERT_EQ(CalibrationStore(calibrations_).add(other)->number, 3);
  const auto older = scan("older", {.steps = kSteps, .calibration = 1});
  EXPECT_EQ(run(*older), ScanState::kDone);
  EXPECT_EQ((*older->folder().record())->calibration, 1);
  const auto of_another = scan("another", {.steps = kSteps, .calibration = 3});
  EXPECT_EQ(run(*of_another), ScanState::kFailed);
  EXPECT_THAT(of_another->status().error->message,
              HasSubstr("calibration 3 is for another camera"));
}

TEST_F(ScanTest, ANewerCalibrationDoesNotTouchAScanThatHasBegun) {
  const std::string expected = undisturbed();
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 4) {
      EXPECT_TRUE(scan->pause());
    }
  };
  ASSERT_EQ(run(*scan), ScanState::kPaused);
  Calibration newer = fake_calibration();
  newer.axis.a = 3;
  ASSERT_TRUE(CalibrationStore(calibrations_).add(newer));
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), expected);
}

TEST_F(ScanTest, ItGoesOnWithNoOtherCalibrationOfThatNumber) {
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call == "turn" && count == 4) {
      EXPECT_TRUE(scan->pause());
    }
  };
  ASSERT_EQ(run(*scan), ScanState::kPaused);
  const std::filesystem::path theirs = calibrations_.string() + "-theirs";
  std::filesystem::rename(calibrations_, theirs);
  Calibration camera = fake_calibration(), region = fake_calibration(), axis = fake_calibration();
  camera.camera = "another";
  region.region.x = 8;
  axis.axis.a = 3;
  for (const Calibration& other : {camera, region, axis}) {
    std::filesystem::remove_all(calibrations_);
    ASSERT_EQ(CalibrationStore(calibrations_).add(other)->number, 1);
    ASSERT_EQ(run(*scan), ScanState::kFailed);
    EXPECT_THAT(scan->status().error->message,
                HasSubstr("is not the one that the scan was started with; restore that one"));
    EXPECT_FALSE(reprocess(scan->folder(), calibrations_, {}));
  }
  std::filesystem::remove_all(calibrations_);
  std::filesystem::rename(theirs, calibrations_);
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

TEST_F(ScanTest, ItGoesOnWithNoOtherCamera) {
  {
    auto scan = this->scan();
    world_.meanwhile = [&](const std::string& call, int count) {
      if (call == "turn" && count == 4) {
        EXPECT_TRUE(scan->pause());
      }
    };
    run(*scan);
  }
  world_.meanwhile = {};
  world_.serial = "fake-2";
  auto scan = reopened();
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(scan->status().error->message,
              HasSubstr("started with camera fake-1, this is camera fake-2"));
}

TEST_F(ScanTest, WhatTheFirstFramesLackIsNamedWithWhatToDo) {
  const auto refused = [&](FakeObject object, const char* name) {
    world_.object = object;
    auto scan = Scan::create(scanner(), request(), path());
    EXPECT_EQ(run(**scan), ScanState::kFailed) << name;
    EXPECT_THAT((*scan)->status().error.value_or(Error{}).message, HasSubstr(name));
    expect_dark(world_);
    EXPECT_EQ((*scan)->status().steps_done, 0);
  };
  refused(FakeObject::kNothing, "no stripe");
  refused(FakeObject::kEmptyTable, "empty turntable");
  refused(FakeObject::kSaturated, "all saturated");
  refused(FakeObject::kTwoStripes, "two stripes");
  refused(FakeObject::kOverExposed, "over-exposed");
}

TEST_F(ScanTest, AStripeThatIsLostOnTheWayStopsTheScanOnce) {
  constexpr int kSecondLook = 18;
  auto scan = this->scan("scan", {.steps = 40});
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call != "turn") return;
    const bool is_lost = count >= 12 && count < 30 && count != kSecondLook;
    const std::lock_guard lock(world_.mutex);
    world_.object = is_lost ? FakeObject::kNothing : FakeObject::kColumn;
  };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  // The table's first motion is part of the checks before the scan. Motion 12 is therefore step 11,
  // at which the stripe is lost.
  EXPECT_THAT(scan->status().error->message,
              HasSubstr("the stripe is lost since step 11 of the scan, no stripe: 0 rows of 5"));
  EXPECT_EQ(scan->status().steps_done, 10) << "the others are measured again";
  EXPECT_EQ(scan->folder().measured()->profiles.size(), 10u);
  expect_dark(world_);
  EXPECT_EQ(run(*scan), ScanState::kDone) << "the operator resumed";
}

TEST_F(ScanTest, StepsThatALaserMissedAreMeasuredAgainOnceItIsBack) {
  auto scan = this->scan();
  const auto show = [&](double from) {
    world_.meanwhile = [&, from](const std::string& call, int) {
      if (call != "capture") return;
      const std::lock_guard lock(world_.mutex);
      world_.object = world_.degrees >= from ? FakeObject::kNothing : FakeObject::kColumn;
    };
  };
  show(120);
  ASSERT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(scan->status().error->message,
              AllOf(HasSubstr("lost since step 5 of"), HasSubstr("measures again from there")));
  scan = reopened();
  EXPECT_EQ(scan->status().steps_done, 4);
  show(240);
  ASSERT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(scan->status().error->message, HasSubstr("lost since step 9 of"));
  show(360);
  ASSERT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

// A process is killed after it has stored the step at which the stripe is lost, but before it has
// recorded the loss.
TEST_F(ScanTest, ACrashJustWhenTheStripeIsLostDoesNotHideThat) {
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int) {
    if (call != "capture") return;
    const std::lock_guard lock(world_.mutex);
    world_.object = world_.degrees >= 120 ? FakeObject::kNothing : FakeObject::kColumn;
  };
  ASSERT_EQ(run(*scan), ScanState::kFailed);
  const auto message = scan->status().error->message;
  const auto journal = scan->folder().journal();
  scan.reset();
  // Size of the journal's last record, in bytes: header, body and checksum.
  constexpr std::uintmax_t kNote = 8 + 8 + 8;
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) - kNote);
  scan = reopened();
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_EQ(scan->status().error.value_or(Error{}).message, message);
  EXPECT_EQ(scan->status().steps_done, 4);
}

// The scan must stop at the same step whether or not it is paused between two steps.
TEST_F(ScanTest, APauseWhileTheStripeIsLostDoesNotHideThat) {
  constexpr int kManySteps = 40;
  const auto run_with_pause_at = [&](int pause) {
    auto scan = this->scan(fmt::format("paused-{}", pause), {.steps = kManySteps});
    world_.calls.clear();
    world_.degrees = 0;
    world_.meanwhile = [&](const std::string& call, int count) {
      if (call == "turn" && count == pause) (void)scan->pause();
      if (call != "capture") return;
      const std::lock_guard lock(world_.mutex);
      const bool is_lost = world_.degrees >= 99 && world_.degrees < 180;
      world_.object = is_lost ? FakeObject::kNothing : FakeObject::kColumn;
    };
    EXPECT_EQ(run(*scan), pause > 0 ? ScanState::kPaused : ScanState::kFailed);
    if (pause > 0) {
      EXPECT_EQ(run(*scan), ScanState::kFailed) << pause;
    }
    EXPECT_EQ(scan->status().steps_done, 11) << pause;
    return scan->status().error.value_or(Error{}).message;
  };
  const std::string undisturbed = run_with_pause_at(0);
  EXPECT_THAT(undisturbed, HasSubstr("the stripe is lost since step 12 of the scan, no stripe"));
  EXPECT_EQ(std::ranges::count(undisturbed, ';'), 1) << undisturbed;
  for (const int pause : {10, 13, 14, 15})
    EXPECT_EQ(run_with_pause_at(pause), undisturbed) << pause;
}

TEST_F(ScanTest, ASecondLaserThatComesOnOnTheWayStopsTheScanOnce) {
  auto scan = this->scan("scan", {.steps = 40});
  world_.meanwhile = [&](const std::string& call, int) {
    if (call != "capture") return;
    const std::lock_guard lock(world_.mutex);
    const bool is_on = world_.degrees >= 180 && world_.degrees < 300;
    world_.object = is_on ? FakeObject::kTwoStripes : FakeObject::kColumn;
  };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(
      scan->status().error.value_or(Error{}).message,
      AllOf(HasSubstr("the stripe has changed since step 19 of the scan, two stripes: 72 of "
                      "120 rows"),
            HasSubstr(
                "rows show the laser twice; cover reflecting surfaces, and switch the other laser "
                "off, then start a new scan")));
  EXPECT_EQ(scan->status().steps_done, 18) << "the others are measured again";
  expect_dark(world_);
  EXPECT_EQ(run(*scan), ScanState::kDone) << "the operator resumed";
}

TEST_F(ScanTest, OneSideThatIsSaturatedDoesNotStopTheScan) {
  auto scan = this->scan("scan", {.steps = 40});
  world_.meanwhile = [&](const std::string& call, int) {
    if (call != "capture") return;
    const std::lock_guard lock(world_.mutex);
    world_.object = world_.degrees >= 180 ? FakeObject::kSaturated : FakeObject::kColumn;
  };
  EXPECT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
}

TEST_F(ScanTest, AFewStepsWithoutStripeAreTheObjectSShape) {
  auto scan = this->scan("scan", {.steps = 40});
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call != "turn") return;
    const std::lock_guard lock(world_.mutex);
    world_.object = count % 10 < 6 ? FakeObject::kColumn : FakeObject::kNothing;
  };
  EXPECT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
}

TEST_F(ScanTest, AnObjectPutOnTheTableAfterARefusalIsScanned) {
  world_.object = FakeObject::kNothing;
  auto scan = this->scan();
  ASSERT_EQ(run(*scan), ScanState::kFailed);
  world_.object = FakeObject::kColumn;
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

}  // namespace
}  // namespace vitrine::test
