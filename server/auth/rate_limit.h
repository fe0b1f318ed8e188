// SPDX-License-Identifier: Apache-2.0
// Limits the rate of calls of each token or address. Uses a fixed amount of memory.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>

namespace vitrine::server {

// Keeps a budget of calls for each access token or address (token-bucket algorithm). A budget grows
// by `rate` calls per second, up to `rate` * kBurst calls. Tokens and addresses whose salted hashes
// collide share a budget. Thread-safe.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kBurst = 10;  // seconds in which an empty budget becomes full

  explicit RateLimit(std::uint32_t rate);  // `rate`: calls per second; 0: no limit

  // Takes one call from the budget of `who`. Returns zero, or the time until the next call is
  // allowed.
  std::chrono::seconds take(std::string_view who, Clock::time_point now = Clock::now());

 private:
  struct Budget {
    Clock::time_point since{};  // time of the last change of `calls`; {} if the budget is full
    double calls = 0;
  };
  const double rate_;
  const std::uint64_t salt_;
  std::mutex mutex_;  // guards the members below
  std::array<Budget, 4096> budgets_{};
};

}  // namespace vitrine::server
