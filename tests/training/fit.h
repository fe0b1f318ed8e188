// SPDX-License-Identifier: Apache-2.0
// Fits the initial state of an adaptive bit to the bit's decisions in many chunks.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrine::training {

struct BitCounts {
  std::uint32_t zeros = 0, ones = 0;  // decisions of one adaptive bit in one chunk
};

// The initial state of an adaptive bit (trained_tables.h).
struct Start {
  int step, seen;
};

// Returns the initial state with which the decisions of all chunks take the fewest bits. A state
// that has seen n decisions counts as a beta prior of n + 1/2 decisions. If `chunks` is empty,
// returns the state in which both values are equally likely.
Start fit_start(const std::vector<BitCounts>& chunks);

}  // namespace vitrine::training
