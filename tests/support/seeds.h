// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vitrine::test {

// How many of `count` cases, random or spread over a file, this build tries. Sanitizers take ten
// times as long and look for faults that show in any case: a tenth is enough for them.
constexpr std::uint64_t seeds(std::uint64_t count) {
#ifdef VITRINE_SANITISED
  return count / 10;
#else
  return count;
#endif
}

}  // namespace vitrine::test
