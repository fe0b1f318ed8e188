// SPDX-License-Identifier: Apache-2.0
// How often each token or address may call, in memory that does not grow with their number.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>

namespace vitrine {

// Thread-safe. Each has a budget that fills up by `rate` calls a second to `rate` * kBurst calls.
// Those whose (salted) hashes collide share theirs.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kBurst = 10;  // seconds' worth that may come at once

  explicit RateLimit(std::uint32_t rate);  // 0: no limit

  // Takes one call from the budget. Zero where there was one; else how long until there is.
  std::chrono::seconds take(std::string_view who, Clock::time_point now = Clock::now());

 private:
  struct Budget {
    Clock::time_point since{};  // when it had `calls`; the start of time: it is full
    double calls = 0;
  };
  const double rate_;
  const std::uint64_t salt_;
  std::mutex mutex_;  // guards what follows
  std::array<Budget, 4096> budgets_{};
};

}  // namespace vitrine
