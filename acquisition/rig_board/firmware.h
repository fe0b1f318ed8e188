// SPDX-License-Identifier: Apache-2.0
// The firmware of a simulated board. It receives bytes and the time, and returns bytes and the
// table's motion. It does no I/O and reads no clock: the caller passes the time in seconds, which
// must never decrease.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::acquisition::rig {

struct FirmwareSettings {
  double degrees_per_second = 0;  // speed of the table; if 0, motions complete at once
  // Motor steps in one revolution. The table always rests at a whole step.
  int steps_per_turn = 28800;
};

class Firmware {
 public:
  virtual ~Firmware() = default;

  // Simulates power-up or a rising DTR: clears all state except the table's angle.
  void restart(double now);
  void receive(std::string_view bytes, double now);
  // Completes the motion if its end time has passed.
  void advance(double now);
  // Returns the time at which the current motion ends, or infinity if there is no motion or the
  // motor is stalled.
  double next() const;
  // Returns and clears the board's output.
  std::string take_output();

  // Stalls the motor: the current motion and all later ones do not end until the next restart.
  void stall() { is_stalled_ = true; }

  // Returns the table's true angle in degrees, which the board may not know.
  double table(double now) const;
  double goal() const;  // returns the table's angle after the current motion
  bool laser() const { return is_laser_on_; }
  bool motor() const { return is_motor_on_; }
  bool moving() const { return motion_.has_value(); }

 protected:
  explicit Firmware(const FirmwareSettings& settings) : settings_(settings) {}

  // Each dialect implements these functions. take() handles one byte, forget() clears all state,
  // and completed() is called after a motion.
  virtual void take(char byte, double now) = 0;
  virtual void forget() = 0;
  virtual void completed(double now) = 0;

  void say(std::string_view text) { output_ += text; }
  double degrees_per_step() const { return 360.0 / settings_.steps_per_turn; }
  // Starts a motion by `steps` motor steps, which may be negative.
  void move_by(long steps, double now);
  // Stops the motion and returns the number of steps made so far.
  long stop_moving(double now);

  bool is_laser_on_ = false, is_motor_on_ = false;

 private:
  struct Motion {
    long steps = 0;
    double begin = 0, end = 0;
  };
  long made(double now) const;

  const FirmwareSettings settings_;
  std::optional<Motion> motion_;
  long table_ = 0;  // the table's angle in steps, before the current motion
  bool is_stalled_ = false;
  std::string output_;
};

// Simulates Horus 0.2. This firmware counts steps. It accepts `?`, `$G`, `$X` and 0x18 at any time.
std::unique_ptr<Firmware> horus_firmware(const FirmwareSettings& settings);
// Simulates FabScanPi, which echoes its input, does not count steps, and ignores input while the
// table turns.
std::unique_ptr<Firmware> fabscan_firmware(const FirmwareSettings& settings);

}  // namespace vitrine::acquisition::rig
