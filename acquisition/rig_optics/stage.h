// SPDX-License-Identifier: Apache-2.0
// The scene in front of the camera. Board and operator change the scene; the camera reads it.
#pragma once

#include <functional>
#include <mutex>
#include <optional>

namespace vitrine::acquisition::rig {

struct Setting {
  double degrees = 0;  // the angle to which the table was commanded
  bool is_laser_on = false;
  bool is_motor_on = false;  // whether the motor holds or turns the table
  int turns = 0;             // number of completed motions
  // Pose of the calibration target on the stage. nullopt: the object is on the table instead.
  std::optional<int> target;
  bool operator==(const Setting&) const = default;
};

// The rig's changing state: table, laser, motor and target. Several threads may use it.
class Stage {
 public:
  // turned_to() calls this function with the number of completed motions, without holding the lock.
  using OnTurn = std::function<void(int turns)>;
  explicit Stage(OnTurn on_turn = {}) : on_turn_(std::move(on_turn)) {}

  // Reports the table's angle during a motion.
  void passes(double degrees);
  // Reports that the table has stopped at `degrees`, relative to the table's initial position.
  void turned_to(double degrees);
  void laser(bool on);
  void motor(bool on);

  void place_object();
  void place_target(int pose);

  Setting now() const;

 private:
  const OnTurn on_turn_;
  mutable std::mutex mutex_;
  Setting setting_;
};

}  // namespace vitrine::acquisition::rig
