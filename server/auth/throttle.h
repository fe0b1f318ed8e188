// SPDX-License-Identifier: Apache-2.0
// Counts the failures of each address, in memory that does not grow with the number of addresses.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>

namespace vitrine {

// Thread-safe. Addresses whose (salted) hashes collide share their failures.
class Throttle {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint32_t kFailures = 10;  // allowed in each kWindow
  static constexpr std::chrono::seconds kWindow{60};

  Throttle();

  // Counts a failure. Zero where it is still allowed; else how long until the next one is.
  std::chrono::seconds failed(std::string_view address, Clock::time_point now = Clock::now());

 private:
  struct Slot {
    Clock::time_point start;  // of the window that `failures` counts
    std::uint32_t failures = 0;
  };
  const std::uint64_t salt_;
  std::mutex mutex_;  // guards what follows
  std::array<Slot, 4096> slots_{};
};

}  // namespace vitrine
