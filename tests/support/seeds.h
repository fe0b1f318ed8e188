// SPDX-License-Identifier: Apache-2.0
// The number of cases that a test tries.
#pragma once

#include <cstdint>

namespace vitrine::test {

// Returns how many of `count` random or evenly spread cases this build tries. A build with
// sanitizers takes ten times as long for each case, so it tries a tenth of them.
constexpr std::uint64_t seeds(std::uint64_t count) {
#ifdef VITRINE_SANITISED
  return count / 10;
#else
  return count;
#endif
}

}  // namespace vitrine::test
