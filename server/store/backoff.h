// SPDX-License-Identifier: Apache-2.0
// Exponential back-off with random pauses.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>
#include <thread>

namespace vitrine::server {

// The number of attempts and the pauses between them. Each pause is random. Its upper bound doubles
// with each failure. Clients that failed at the same time therefore retry at different times.
struct Backoff {
  int attempts = 5;
  // upper bound of the first pause, and limit of the upper bound
  std::chrono::milliseconds first{100}, longest{3000};
  std::function<void(std::chrono::milliseconds)> pause = [](std::chrono::milliseconds time) {
    std::this_thread::sleep_for(time);
  };

  // Pauses after failure number `failures`, counted from 1.
  void wait(int failures) const {
    thread_local std::minstd_rand random{std::random_device()()};
    const auto bound = std::min(longest, first * (1 << std::min(failures - 1, 16)));
    pause(std::chrono::milliseconds(
        std::uniform_int_distribution<std::chrono::milliseconds::rep>(0, bound.count())(random)));
  }
};

}  // namespace vitrine::server
