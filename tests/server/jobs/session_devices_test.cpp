// SPDX-License-Identifier: Apache-2.0
// Tests how a backend uses the devices of a scanner: scans, calibrations, stops and a lost board.
#include <gtest/gtest.h>

#include <future>
#include <new>

#include "../../acquisition/session/fake_scanner.h"
#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/scan_folder.h"
#include "server/jobs/session_backend.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class SessionDevices : public testing::Test {
 protected:
  // Makes the open board fail from now on. A board that is opened later works.
  void lose_board() {
    const int lost = world_.calls["open board"];
    world_.fault = [this, lost](const std::string& call, int) {
      return world_.calls["open board"] == lost && call != "open board";
    };
  }

  TemporaryFolder folder_;
  FakeWorld world_;
  SessionBackend backend_{
      {.name = "fake", .target = {9, 14, 8, 6, "DICT_4X4_100"}, .calibrations = folder_.path()},
      fake_scanner(world_, folder_.path())};
};

struct ThrowingListener final : ScanListener {
  void begins(std::shared_ptr<const ScanView>) override {}
  void report(const ScanProgress& progress) override {
    if (progress.step <= 3) return;
    threw.set_value();
    throw std::bad_alloc();
  }
  bool is_interrupted() const override { return false; }
  bool is_cancelled() const override { return false; }

  std::promise<void> threw;
};

TEST_F(SessionDevices, AScanWhoseListenerThrowsHasEnded) {
  ASSERT_TRUE(CalibrationStore(folder_.path()).add(fake_calibration()));
  ThrowingListener listener;
  world_.meanwhile = [threw = listener.threw.get_future().share()](const std::string& call,
                                                                   int count) {
    if (call == "capture" && count == 40) threw.wait();
  };
  ScanOrder order;
  order.request.steps = 200;
  EXPECT_THROW((void)backend_.scan(order, folder_.path() / "scan", listener), std::bad_alloc);
  const std::lock_guard lock(world_.mutex);
  EXPECT_EQ(world_.open_boards, 0);
  EXPECT_FALSE(world_.laser || world_.motor);
}

TEST_F(SessionDevices, AScanReportsItsRows) {
  struct Listener final : ScanListener {
    void begins(std::shared_ptr<const ScanView>) override {}
    void report(const ScanProgress& progress) override { last = progress; }
    bool is_interrupted() const override { return false; }
    bool is_cancelled() const override { return false; }
    ScanProgress last;
  } listener;
  ASSERT_TRUE(CalibrationStore(folder_.path()).add(fake_calibration()));
  world_.object = FakeObject::kTwoSurfaces;
  ScanOrder order;
  order.request.steps = 12;
  ASSERT_TRUE(backend_.scan(order, folder_.path() / "scan", listener));
  EXPECT_EQ(listener.last.calibration, 1);
  EXPECT_EQ(listener.last.rows, (ScannedRows{.empty = 0, .saturated = 0, .doubled = .5}));
  const auto later = backend_.view(folder_.path() / "scan");
  ASSERT_TRUE(later) << later.error().message;
  EXPECT_EQ((*later)->progress().calibration, 1);
  EXPECT_EQ((*later)->progress().rows, listener.last.rows);
}

struct SilentListener final : ScanListener {
  void begins(std::shared_ptr<const ScanView>) override {}
  void report(const ScanProgress&) override {}
  bool is_interrupted() const override { return false; }
  bool is_cancelled() const override { return false; }
};

TEST_F(SessionDevices, AScanUsesTheCalibrationThatWasOrdered) {
  for (int number = 1; number <= 2; ++number)
    ASSERT_TRUE(CalibrationStore(folder_.path()).add(fake_calibration()));
  ScanOrder order{.calibration = 1};
  order.request.steps = 12;
  SilentListener listener;
  ASSERT_TRUE(backend_.scan(order, folder_.path() / "scan", listener));
  EXPECT_EQ((*ScanFolder::open(folder_.path() / "scan")->record())->calibration, 1);
}

TEST_F(SessionDevices, AStopWhileTheBoardIsOpenedHoldsUntilItIsUndone) {
  world_.meanwhile = [this](const std::string& call, int) {
    if (call == "open board") backend_.emergency_stop();
  };
  EXPECT_EQ(backend_.jog(10).error().code, ErrorCode::kState);
  world_.meanwhile = {};
  backend_.allow(0);  // a client that has not seen the stop sends the old number of stops
  EXPECT_EQ(backend_.jog(10).error().code, ErrorCode::kState);
  EXPECT_EQ(world_.degrees, 0);
  EXPECT_TRUE(backend_.picture());
  backend_.allow(backend_.stops());
  EXPECT_TRUE(backend_.jog(10));
  EXPECT_EQ(world_.degrees, 10);
}

TEST_F(SessionDevices, TheCommandAfterAStopIsObeyed) {
  ASSERT_TRUE(backend_.laser(true));
  backend_.emergency_stop();
  EXPECT_FALSE(world_.laser);
  backend_.allow(backend_.stops());
  EXPECT_TRUE(backend_.jog(10));
}

TEST_F(SessionDevices, ALaserThatTheWatchdogSwitchedOffCanBeSwitchedOff) {
  ASSERT_TRUE(backend_.laser(true));
  lose_board();
  EXPECT_TRUE(backend_.laser(false));
  EXPECT_FALSE(world_.laser);
  EXPECT_EQ(world_.calls["rest"], 1);
}

TEST_F(SessionDevices, ABoardThatWasPluggedInAgainIsUsed) {
  ASSERT_TRUE(backend_.identify());
  lose_board();
  EXPECT_TRUE(backend_.identify());
  EXPECT_TRUE(backend_.jog(10));
}

// An operator who places the target on request, unless `refuse` is set.
struct Hands final : CalibrationListener {
  void report(const CalibrationProgress&) override {}
  bool await_operator(const CalibrationProgress& progress) override {
    asked.push_back(progress.stage);
    return !refuse;
  }
  bool is_interrupted() const override { return interrupted; }

  std::vector<std::string> asked;
  bool refuse = false, interrupted = false;
};

TEST_F(SessionDevices, WithoutARigTheOperatorIsAskedForEachPose) {
  Hands hands;
  const auto number = backend_.calibrate({.poses = 3}, hands);
  ASSERT_FALSE(number);
  EXPECT_NE(number.error().message.find("target never seen"), std::string::npos);
  const std::vector<std::string> asked = {"place the target, pose 1 of 3",
                                          "place the target, pose 2 of 3",
                                          "place the target, pose 3 of 3"};
  EXPECT_EQ(hands.asked, asked);
}

TEST_F(SessionDevices, ACalibrationWithoutAnOperatorEnds) {
  Hands hands;
  hands.refuse = true;
  EXPECT_EQ(backend_.calibrate({.poses = 3}, hands).error().code, ErrorCode::kState);
  EXPECT_EQ(world_.calls["capture"], 0);
}

TEST_F(SessionDevices, ACalibrationCanBeInterruptedDuringAPose) {
  Hands hands;
  world_.meanwhile = [&hands](const std::string& call, int count) {
    if (call == "capture" && count == 4) hands.interrupted = true;
  };
  EXPECT_EQ(backend_.calibrate({.poses = 3}, hands).error().code, ErrorCode::kState);
  EXPECT_EQ(world_.calls["capture"], 4);
  EXPECT_FALSE(world_.laser || world_.motor);
}

}  // namespace
}  // namespace vitrine::test
