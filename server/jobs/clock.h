// SPDX-License-Identifier: Apache-2.0
// The current time as a number of milliseconds, as in the records of models, jobs and scans.
#pragma once

#include <chrono>
#include <cstdint>

namespace vitrine::server {

// Returns the current time in milliseconds since 1970, UTC.
inline std::int64_t now_in_milliseconds() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace vitrine::server
