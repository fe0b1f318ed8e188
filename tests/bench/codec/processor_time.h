// SPDX-License-Identifier: Apache-2.0
// Measures how long work takes.
#pragma once

#include <chrono>
#include <ctime>
#include <functional>

namespace vitrine::bench {

// Returns the processor time of `work` in seconds. Wall time would depend on the machine's other
// load. All compared work runs on one thread.
inline double seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Returns the wall time of `work` in seconds, for work on several threads.
inline double wall_seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace vitrine::bench
