// SPDX-License-Identifier: Apache-2.0
// Limits the failed authentications of each address. Uses a fixed amount of memory.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>

namespace vitrine::server {

// Counts failures in windows of fixed length. Addresses whose salted hashes collide share a count.
// Thread-safe.
class Throttle {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint32_t kFailures = 10;  // failures allowed in each window
  static constexpr std::chrono::seconds kWindow{60};

  Throttle();

  // Counts a failure. Returns zero if the failure is within the limit, otherwise the time until the
  // window ends.
  std::chrono::seconds failed(std::string_view address, Clock::time_point now = Clock::now());

 private:
  struct FailureCount {
    Clock::time_point start;  // start of the window in which `failures` occurred
    std::uint32_t failures = 0;
  };
  const std::uint64_t salt_;
  std::mutex mutex_;  // guards the members below
  std::array<FailureCount, 4096> slots_{};
};

}  // namespace vitrine::server
