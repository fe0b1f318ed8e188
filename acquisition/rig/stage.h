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
  int turns = 0;  // motions that were begun
  std::optional<int>
      target;  // the pose of the calibration target; nothing: the object stands there
  bool operator==(const Setting&) const = default;
};

// For several threads at once.
class Stage {
 public:
  // Called by turn_to() with the count of turns, this one included, before the table has moved and
  // without the lock: it may take time, and unplug things. False: the motor stalls.
  using OnTurn = std::function<bool(int turns)>;
  explicit Stage(OnTurn on_turn = {}) : on_turn_(std::move(on_turn)) {}

  // The table stands at `degrees` (a board counts from where it was switched on) when this returns.
  // False: the motor stalls, the table has not moved and the motion never completes.
  [[nodiscard]] bool turn_to(double degrees);
  void laser(bool on);

  void place_object();
  void place_target(int pose);

  Setting now() const;

 private:
  const OnTurn on_turn_;
  mutable std::mutex mutex_;
  Setting setting_;
};

}  // namespace vitrine::rig
