// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <functional>

namespace vitrine::bench {

// Returns the processor time of `work` in seconds. Wall time would depend on other users of the
// machine. All compared work runs on one thread.
inline double seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace vitrine::bench
