// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>
#include <thread>

namespace vitrine {

// How often something is tried and how long to wait in between: at random up to a bound that
// doubles, so that the many who failed together do not come back together.
struct Backoff {
  int attempts = 5;
  std::chrono::milliseconds first{100}, longest{3000};  // bounds
  std::function<void(std::chrono::milliseconds)> pause = [](std::chrono::milliseconds time) {
    std::this_thread::sleep_for(time);
  };

  // After the `failures`th failure, counted from 1.
  void wait(int failures) const {
    thread_local std::minstd_rand random{std::random_device()()};
    const auto bound = std::min(longest, first * (1 << std::min(failures - 1, 16)));
    pause(std::chrono::milliseconds(
        std::uniform_int_distribution<std::chrono::milliseconds::rep>(0, bound.count())(random)));
  }
};

}  // namespace vitrine
