// SPDX-License-Identifier: Apache-2.0
// Fits where an adaptive bit should start from what it met in many chunks.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrine::training {

struct Counts {
  std::uint32_t zeros = 0, ones = 0;  // of one context in one chunk
};

// An adaptive bit's start (trained_tables.h).
struct Start {
  int step, seen;
};

// The start under which the chunks cost least: an adaptive bit
// that has seen n decisions is close to a beta prior of n + 1/2 decisions. A context that was never
// met starts undecided.
Start fit_start(const std::vector<Counts>& chunks);

}  // namespace vitrine::training
