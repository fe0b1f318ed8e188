// SPDX-License-Identifier: Apache-2.0
// The emergency stop of a scanner. A press may come from any thread. It stops the open board and
// every board opened later, until the press is released.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>

#include "acquisition/device/board.h"

namespace vitrine::acquisition {

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
  std::uint64_t presses() const {  // number of presses so far
    const std::lock_guard lock(mutex_);
    return presses_;
  }
  // Releases the first `presses` presses. Later presses stay in effect.
  void release(std::uint64_t presses) {
    const std::lock_guard lock(mutex_);
    released_ = std::max(released_, presses);
  }

  // Makes every press from now on stop `board`, until guard(nullptr) is called. If an earlier press
  // is still in effect, stops `board` at once.
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

}  // namespace vitrine::acquisition
