// SPDX-License-Identifier: Apache-2.0
// The red button of a scanner: reaches the board that is open now from any thread, and keeps one
// that is opened later from being used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>

#include "acquisition/device/board.h"

namespace vitrine {

class EmergencyStop {
 public:
  void press() noexcept {
    const std::lock_guard lock(mutex_);
    ++presses_;
    if (board_ != nullptr) board_->emergency_stop();
  }
  bool is_pressed() const {
    const std::lock_guard lock(mutex_);
    return presses_ > released_;
  }
  std::uint64_t presses() const {  // how many so far
    const std::lock_guard lock(mutex_);
    return presses_;
  }
  // Takes back the first `presses`: a later one holds.
  void release(std::uint64_t presses) {
    const std::lock_guard lock(mutex_);
    released_ = std::max(released_, presses);
  }

  // Until guard(nullptr) `board` is stopped with a press; at once where that was before.
  void guard(Board* board) {
    const std::lock_guard lock(mutex_);
    board_ = board;
    if (presses_ > released_ && board_ != nullptr) board_->emergency_stop();
  }

 private:
  mutable std::mutex mutex_;
  Board* board_ = nullptr;
  std::uint64_t presses_ = 0, released_ = 0;
};

}  // namespace vitrine
