// SPDX-License-Identifier: Apache-2.0
// The red button of a scanner: reaches the board that is open now from any thread, and keeps one
// that is opened later from being used.
#pragma once

#include <mutex>

#include "acquisition/device/board.h"

namespace vitrine {

class EmergencyStop {
 public:
  void press() noexcept {
    const std::lock_guard lock(mutex_);
    pressed_ = true;
    if (board_ != nullptr) board_->emergency_stop();
  }
  bool is_pressed() const {
    const std::lock_guard lock(mutex_);
    return pressed_;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    pressed_ = false;
  }

  // Until guard(nullptr) `board` is stopped with a press; at once where that was before.
  void guard(Board* board) {
    const std::lock_guard lock(mutex_);
    board_ = board;
    if (pressed_ && board_ != nullptr) board_->emergency_stop();
  }

 private:
  mutable std::mutex mutex_;
  Board* board_ = nullptr;
  bool pressed_ = false;
};

}  // namespace vitrine
