// SPDX-License-Identifier: Apache-2.0
// What runs on a simulated board: bytes and time in, bytes and a table's motion out. No I/O, no
// clock: time is in seconds since whenever, and never runs backwards.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::rig {

struct FirmwareSettings {
  double degrees_per_second = 0;  // 0: motions are complete at once
  int steps_per_turn = 28800;     // motor steps; the table stands at one of them
};

class Firmware {
 public:
  virtual ~Firmware() = default;

  // Power has come, or DTR has risen: all is forgotten but where the table is.
  void restart(double now);
  void receive(std::string_view bytes, double now);
  // Completes the motion whose time has come.
  void advance(double now);
  // When advance() has something to do next; never: infinity.
  double next() const;
  // What it says; forgotten when taken.
  std::string take_output();

  // The motion under way and all later ones never end, until the next restart.
  void stall() { stalled_ = true; }

  double table(double now) const;  // where the table is, degrees; not what the board believes
  double goal() const;             // where it is once the motion under way is complete
  bool laser() const { return laser_; }
  bool motor() const { return motor_; }
  bool moving() const { return motion_.has_value(); }

 protected:
  explicit Firmware(const FirmwareSettings& settings) : settings_(settings) {}

  // What the dialect knows: obeys a byte; forgets all; goes on after a motion.
  virtual void take(char byte, double now) = 0;
  virtual void forget() = 0;
  virtual void completed(double now) = 0;

  void say(std::string_view text) { output_ += text; }
  double degrees_per_step() const { return 360.0 / settings_.steps_per_turn; }
  void move_by(long steps, double now);
  // Where it is; returns the steps made.
  long stop_moving(double now);

  bool laser_ = false, motor_ = false;

 private:
  struct Motion {
    long steps = 0;
    double begin = 0, end = 0;
  };
  long made(double now) const;

  const FirmwareSettings settings_;
  std::optional<Motion> motion_;
  long table_ = 0;  // steps, before the motion under way
  bool stalled_ = false;
  std::string output_;
};

// Horus 0.2: counts, knows `?`, `$G`, `$X`, and 0x18 at any time.
std::unique_ptr<Firmware> horus_firmware(const FirmwareSettings& settings);
// FabScanPi: echoes, does not count; reads nothing while the table turns.
std::unique_ptr<Firmware> fabscan_firmware(const FirmwareSettings& settings);

}  // namespace vitrine::rig
