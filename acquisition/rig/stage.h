// SPDX-License-Identifier: Apache-2.0
// What stands before the camera just now: told by the board and the operator, asked by the camera.
#pragma once

#include <functional>
#include <mutex>
#include <optional>

namespace vitrine::rig {

struct Setting {
  double degrees = 0;  // of the table, as the motor was told
  bool laser = false;
  bool motor = false;  // holds or turns the table
  int turns = 0;       // motions that were completed
  std::optional<int>
      target;  // the pose of the calibration target; nothing: the object stands there
  bool operator==(const Setting&) const = default;
};

// For several threads at once.
class Stage {
 public:
  // Called by turned_to() with the count of motions, without the lock.
  using OnTurn = std::function<void(int turns)>;
  explicit Stage(OnTurn on_turn = {}) : on_turn_(std::move(on_turn)) {}

  // The table is at `degrees` amid a motion.
  void passes(double degrees);
  // The table has come to stand at `degrees`, counted from where it first stood.
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

}  // namespace vitrine::rig
