// SPDX-License-Identifier: Apache-2.0
// Injects faults at every step of a scan. After each fault, laser and motor must be off, no profile
// may be lost, and the final mesh must have the same bits as without faults.
#include <fmt/format.h>
#include <sys/resource.h>

#include <csignal>

#include "scan_test.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kCalls = {"turn",      "capture", "laser on",
                                         "laser off", "rest",    "position"};

TEST_F(ScanTest, ADeviceUnpluggedAtAnyCallIsOpenedAnewAndNothingIsLost) {
  const std::string expected = undisturbed();
  for (const bool forgets : {false, true}) {
    for (const std::string& lost : kCalls) {
      for (int moment = 2; moment <= 2 * kSteps + 2; ++moment) {
        const std::string name = fmt::format("{}-{}-{}", lost, moment, forgets);
        world_.calls.clear();
        world_.degrees = 0, world_.position_known = true;
        world_.forgets_position = false;
        bool is_lost = false;
        world_.fault = [&](const std::string& call, int count) {
          if (call != lost || count != moment) return false;
          is_lost = true;
          world_.forgets_position = forgets;
          return true;
        };
        auto scan = this->scan(name);
        // The fixture allows no retries until the first checks have passed, so a fault during these
        // checks makes the scan fail.
        if (run(*scan) == ScanState::kFailed) {
          expect_dark(world_);
          EXPECT_TRUE(is_lost);
          EXPECT_EQ(run(*scan), ScanState::kDone) << name;
        }
        EXPECT_EQ(mesh_text(*scan), expected) << name;
        expect_dark(world_);
        if (!is_lost) break;  // the scan makes no further call of this kind
      }
    }
  }
}

// Copies the scan's folder at the moment at which a process is killed. The table still completes
// the current motion. A new process must complete the scan from this copy.
TEST_F(ScanTest, AProcessKilledAtAnyStepLosesNothing) {
  const std::string expected = undisturbed();
  for (const bool forgets : {false, true}) {
    for (const char* moment : {"turn", "capture"}) {
      for (int count = 1; count <= 2 * kSteps + 8; ++count) {
        const std::string name = fmt::format("killed-{}-{}-{}", moment, count, forgets);
        world_.calls.clear();
        world_.degrees = 0, world_.position_known = true, world_.forgets_position = false;
        std::optional<double> stood_at;
        bool killed = false;
        world_.meanwhile = [&](const std::string& call, int n) {
          if (killed && !stood_at) stood_at = world_.degrees;
          if (call != moment || n != count) return;
          std::filesystem::copy(path(name), path(name + "-left"));
          killed = true;
        };
        run(*scan(name));
        world_.meanwhile = {};
        if (!killed) break;  // the scan makes no further call of this kind
        world_.degrees = *stood_at, world_.forgets_position = forgets;
        auto opened = Scan::reopen(scanner(), path(name + "-left"), impatient());
        // There is no scan to resume until the first checks have passed.
        if (!opened) continue;
        EXPECT_EQ(run(**opened), ScanState::kDone);
        EXPECT_EQ(mesh_text(**opened), expected) << name;
      }
    }
  }
}

TEST_F(ScanTest, AJournalTornAnywhereIsCompleted) {
  const std::string expected = undisturbed();
  run(*scan());
  const auto size = std::filesystem::file_size(path() / "profiles");
  const auto step = size / 12 + 1;
  for (std::uintmax_t left = 0; left < size; left += step) {
    const std::string name = fmt::format("torn-{}", left);
    std::filesystem::copy(path(), path(name));
    std::filesystem::resize_file(path(name) / "profiles", left);
    auto scan = reopened(name);
    EXPECT_EQ(run(*scan), ScanState::kDone);
    EXPECT_EQ(mesh_text(*scan), expected) << left;
  }
}

TEST_F(ScanTest, ACameraThatStaysAwayIsAnErrorAndItsReturnIsEnough) {
  bool is_away = false;
  auto scan = this->scan();
  world_.fault = [&](const std::string& call, int count) {
    is_away = is_away || (call == "capture" && count == 9);
    return is_away && (call == "capture" || call == "open camera");
  };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(scan->status().error->message, HasSubstr("is gone at \"open camera\""));
  EXPECT_EQ(world_.calls["open camera"], 1 + 3);  // one attempt, and as many retries as configured
  EXPECT_GE(scan->status().steps_done, 2);
  expect_dark(world_);
  EXPECT_EQ(reopened()->status().state, ScanState::kFailed);
  world_.fault = {};
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

TEST_F(ScanTest, ATableThatDoesNotTurnEndsTheScanAtTheSecondTry) {
  auto made = acquisition::Scan::create(scanner(), request(), path(), impatient(60));
  Scan& scan = **made;
  bool is_stuck = false;
  world_.fault = [&](const std::string& call, int count) {
    is_stuck = is_stuck || (call == "turn" && count == 5);
    return is_stuck && call == "turn";
  };
  EXPECT_EQ(run(scan), ScanState::kFailed);
  EXPECT_THAT(scan.status().error->message, HasSubstr("the table does not turn: the board"));
  EXPECT_EQ(world_.calls["turn"], 6);
  EXPECT_EQ(world_.calls["open board"], 2);
  world_.fault = {};
  world_.forgets_position = true;  // the table then stands where its last complete motion ended
  EXPECT_EQ(run(scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(scan), undisturbed());
}

TEST_F(ScanTest, ACameraThatAKilledProcessStillHoldsIsWaitedFor) {
  auto made = Scan::create(
      scanner(), request(), path(),
      {.retries = {.tries = 0, .first_tries = 3, .between = std::chrono::milliseconds(0)}});
  world_.fault = [](const std::string& call, int count) {
    return call == "open camera" && count <= 3;
  };
  EXPECT_EQ(run(**made), ScanState::kDone);
  EXPECT_EQ(world_.calls["open camera"], 4);
}

TEST_F(ScanTest, AFrameThatComesTwiceIsNoPictureWithTheLaserOnAndBothAreTakenAnew) {
  const std::string expected = undisturbed();
  for (const int count : {2, 4, 10}) {  // numbers of captures, counted over the whole scan
    const std::string name = fmt::format("repeated-{}", count);
    world_.calls.clear();
    world_.degrees = 0;
    world_.repeats = [&](int n) { return n == count || n == count + 2; };
    auto scan = this->scan(name);
    EXPECT_EQ(run(*scan), ScanState::kDone) << name;
    EXPECT_EQ(mesh_text(*scan), expected) << name;
    EXPECT_EQ(world_.calls["open camera"], 1);
  }
}

TEST_F(ScanTest, AFrameThatComesTwiceIsTakenAnewWhereThereIsNoNoiseEither) {
  world_.is_ideal = true;
  auto calm = this->scan("calm");
  ASSERT_EQ(run(*calm), ScanState::kDone);
  world_.calls.clear();
  world_.degrees = 0;
  world_.repeats = [](int count) { return count == 12; };
  auto scan = this->scan("repeated");
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), mesh_text(*calm));
}

TEST_F(ScanTest, ACameraThatRepeatsOneFrameIsAnErrorThatSaysSo) {
  auto scan = this->scan();
  world_.repeats = [](int count) { return count % 2 == 0 && count > 10; };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(
      scan->status().error->message,
      HasSubstr("camera fake-1 delivers the same picture with the laser off and on; check"));
  EXPECT_EQ(world_.calls["capture"], 10 + 4 * 3 * 2)
      << "three pairs, then opened again three times";
  world_.repeats = {};
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

TEST_F(ScanTest, WhatIsThrownEndsTheScanAndNothingElse) {
  const std::string expected = undisturbed();
  for (const char* moment : {"open camera", "turn", "capture", "laser on"}) {
    auto scan = this->scan(moment);
    world_.degrees = 0;
    world_.calls.clear();
    world_.meanwhile = [&](const std::string& call, int count) {
      if (call == moment && (count == 7 || call == "open camera")) throw std::bad_alloc();
    };
    EXPECT_EQ(run(*scan), ScanState::kFailed);
    EXPECT_THAT(scan->status().error.value_or(Error{}).message,
                HasSubstr("the scan cannot continue: std::bad_alloc; free memory and resume it"));
    expect_dark(world_);
    world_.meanwhile = {};
    EXPECT_EQ(run(*scan), ScanState::kDone);
    EXPECT_EQ(mesh_text(*scan), expected) << moment;
  }
}

TEST_F(ScanTest, ACameraWithoutNoiseShowsTheSameTwiceWhereTheLaserMeetsNothing) {
  world_.is_ideal = true;
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call != "turn") return;
    const std::lock_guard lock(world_.mutex);
    world_.object = count % 6 < 4 ? FakeObject::kColumn : FakeObject::kNothing;
  };
  auto scan = this->scan("scan", {.steps = 40});
  EXPECT_EQ(run(*scan), ScanState::kDone) << scan->status().error->message;
  EXPECT_EQ(world_.calls["open camera"], 1);
}

TEST_F(ScanTest, WhileItWaitsForADeviceItSaysSoAndCanBePaused) {
  auto made =
      Scan::create(scanner(), request(), path(),
                   {.retries = {.tries = 1'000'000, .first_tries = 0, .between = kForever}});
  Scan& scan = **made;
  std::atomic<bool> is_away = false;
  world_.fault = [&](const std::string& call, int count) {
    is_away = is_away || (call == "turn" && count == 5);
    return is_away.load();
  };
  ASSERT_TRUE(scan.resume());
  while (scan.status().note.empty())
    std::this_thread::yield();
  EXPECT_EQ(scan.status().state, ScanState::kScanning);
  expect_dark(world_);
  EXPECT_TRUE(scan.pause());
  EXPECT_EQ(scan.wait(kForever).state, ScanState::kPaused);
}

TEST_F(ScanTest, TheEmergencyStopReachesTheBoardWithinAMotion) {
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int count) {
    if (call != "turn" || count != 5) return;
    std::thread([&] { scan->emergency_stop(); }).join();
    const std::lock_guard lock(world_.mutex);
    EXPECT_TRUE(world_.stopped);
    EXPECT_FALSE(world_.laser || world_.motor);
  };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_THAT(scan->status().error->message, HasSubstr("emergency stop"));
  EXPECT_EQ(world_.calls["open board"], 1);  // the board is not switched on again
  world_.meanwhile = {};
  EXPECT_EQ(run(*scan), ScanState::kDone);
  EXPECT_EQ(mesh_text(*scan), undisturbed());
}

TEST_F(ScanTest, AStopWhileTheBoardIsOpenedKeepsTheLaserOff) {
  auto scan = this->scan();
  world_.meanwhile = [&](const std::string& call, int) {
    if (call == "open board") scan->emergency_stop();
  };
  EXPECT_EQ(run(*scan), ScanState::kFailed);
  EXPECT_EQ(world_.calls["laser on"], 0);
}

// Limits the size of the files of this process, to simulate a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(ScanTest, AFullDiskStopsTheScanAndSpaceLetsItGoOn) {
  const std::string expected = undisturbed();
  const auto whole = std::filesystem::file_size(path("undisturbed") / "profiles");
  for (const double share : {0.3, 0.5, 0.77}) {
    const std::string name = fmt::format("full-{}", share);
    auto scan = this->scan(name);
    {
      const SmallDisk disk(static_cast<rlim_t>(share * static_cast<double>(whole)));
      EXPECT_EQ(run(*scan), ScanState::kFailed);
    }
    EXPECT_THAT(scan->status().error->message, HasSubstr("cannot write"));
    EXPECT_GT(scan->status().steps_done, 0);
    expect_dark(world_);
    EXPECT_EQ(run(*scan), ScanState::kDone);
    EXPECT_EQ(mesh_text(*scan), expected);
  }
}

}  // namespace
}  // namespace vitrine::test
