// SPDX-License-Identifier: Apache-2.0
// The state of a board's laser and motor, which other threads may read, even while the board is
// closed.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

namespace vitrine::acquisition {

// kUnknown means that the board was never opened, or that it did not confirm that the laser is off.
enum class LaserState : std::uint8_t { kUnknown, kOff, kOn };
// kHolding means that the motor has power and holds the table still.
enum class MotorState : std::uint8_t { kUnknown, kOff, kHolding, kTurning };

struct BoardPower {
  using Clock = std::chrono::system_clock;

  LaserState laser = LaserState::kUnknown;
  MotorState motor = MotorState::kUnknown;
  // Times at which laser and motor entered these states.
  Clock::time_point laser_since{}, motor_since{};
};

// Thread-safe. The board writes "on" before it sends a command and "off" after the board's
// confirmation, so the record never states that a laser is off while it may be lit.
class PowerRecord {
 public:
  void laser(LaserState state) {
    const std::lock_guard lock(mutex_);
    if (power_.laser == state) return;
    power_.laser = state;
    power_.laser_since = BoardPower::Clock::now();
  }
  void motor(MotorState state) {
    const std::lock_guard lock(mutex_);
    if (power_.motor == state) return;
    power_.motor = state;
    power_.motor_since = BoardPower::Clock::now();
  }
  void both_off() {
    laser(LaserState::kOff);
    motor(MotorState::kOff);
  }
  void unknown() {
    laser(LaserState::kUnknown);
    motor(MotorState::kUnknown);
  }

  BoardPower read() const {
    const std::lock_guard lock(mutex_);
    return power_;
  }

 private:
  mutable std::mutex mutex_;
  BoardPower power_;
};

}  // namespace vitrine::acquisition
