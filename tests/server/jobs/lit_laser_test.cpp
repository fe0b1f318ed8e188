// SPDX-License-Identifier: Apache-2.0
// Tests how long a laser stays on after an operator has switched it on. Also tests the states of
// laser and motor that a station reports.
#include <gtest/gtest.h>

#include <future>

#include "scans_test.h"

namespace vitrine::server {
namespace {

class LitLaser : public ScansTest {
 protected:
  void light() {
    const auto lit = station().switch_laser_on([this] { return is_permitted_.load(); });
    ASSERT_TRUE(lit) << lit.error().message;
  }
  void tend() {
    station().watch_manual_laser();
    settle();
  }
  acquisition::LaserState laser() { return station().status().power.laser; }
  acquisition::MotorState motor() { return station().status().power.motor; }

  std::atomic<bool> is_permitted_{true};
};

TEST_F(LitLaser, StaysOnForAMinuteAndThenGoesOff) {
  light();
  EXPECT_EQ(laser(), acquisition::LaserState::kOn);
  tend();
  EXPECT_TRUE(world_.laser);
  EXPECT_GE(world_.kept, 1) << "the board's watchdog must not switch it off before";
  let_the_laser_end();
  tend();
  EXPECT_FALSE(world_.laser);
  EXPECT_EQ(laser(), acquisition::LaserState::kOff);
  EXPECT_EQ(world_.stops, 0U);
}

TEST_F(LitLaser, LitAgainStaysOnForAnotherMinute) {
  light();
  now_ = now_.load() + kLongestLit / 2;
  light();
  now_ = now_.load() + kLongestLit / 2;
  tend();
  EXPECT_TRUE(world_.laser);
}

TEST_F(LitLaser, GoesOffWhenItsPermitEnds) {
  light();
  is_permitted_ = false;
  tend();
  EXPECT_FALSE(world_.laser);
}

TEST_F(LitLaser, IsNotLitAgainAfterItWasSwitchedOff) {
  light();
  ASSERT_TRUE(station().switch_laser_off());
  const int kept = world_.kept;
  tend();
  EXPECT_FALSE(world_.laser);
  EXPECT_EQ(world_.kept, kept) << "the devices are left to other programs";
}

TEST_F(LitLaser, ThatWasStoppedIsLeftAlone) {
  light();
  station().stop();
  EXPECT_EQ(laser(), acquisition::LaserState::kOff);
  const int calls = world_.calls;
  tend();
  EXPECT_EQ(world_.calls, calls);
}

TEST_F(LitLaser, GoesOffBeforeAJobBegins) {
  world_.is_placed_by_hand = true;
  std::promise<bool> seen;
  world_.before_step = [&](int) -> std::optional<Error> {
    seen.set_value(world_.laser);
    return std::nullopt;
  };
  light();
  const auto job = service_->calibrate(station(), {}, {});
  ASSERT_TRUE(job) << job.error().message;
  EXPECT_FALSE(seen.get_future().get());
  ASSERT_TRUE(service_->jobs().cancel(job->id));
  settle();
}

TEST_F(LitLaser, StopsTheTableThatKeepsItFromGoingOff) {
  std::promise<void> turning, stopped;
  world_.while_turning = [&] {
    turning.set_value();
    stopped.get_future().wait();
  };
  light();
  auto jog = std::async(std::launch::async, [this] { return station().jog(36'000); });
  turning.get_future().wait();
  EXPECT_EQ(motor(), acquisition::MotorState::kTurning);
  let_the_laser_end();
  station().watch_manual_laser();
  EXPECT_EQ(world_.stops, 0U) << "a command that ends soon is not cut off";
  now_ = now_.load() + kLaserGrace;
  station().watch_manual_laser();
  EXPECT_EQ(world_.stops, 1U);
  EXPECT_EQ(laser(), acquisition::LaserState::kOff);
  EXPECT_EQ(motor(), acquisition::MotorState::kOff);
  stopped.set_value();
  EXPECT_FALSE(jog.get());
  world_.while_turning = {};
  EXPECT_TRUE(station().jog(10)) << "the next command is obeyed";
}

TEST_F(LitLaser, IsPutOutByTurningTheTable) {
  light();
  ASSERT_TRUE(station().jog(90));
  EXPECT_EQ(laser(), acquisition::LaserState::kOff);
  const int kept = world_.kept;
  tend();
  EXPECT_EQ(world_.kept, kept);
}

TEST_F(LitLaser, OfABoardInAnUnknownStateIsLookedAfter) {
  settle();
  world_.power.unknown();
  const int calls = world_.calls;
  EXPECT_EQ(laser(), acquisition::LaserState::kUnknown);
  settle();
  EXPECT_GT(world_.calls, calls) << "opening a board switches it off";
}

}  // namespace
}  // namespace vitrine::server
