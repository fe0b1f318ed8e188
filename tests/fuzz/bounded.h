// SPDX-License-Identifier: Apache-2.0
// Bounds the memory of a fuzz target. Aborts the run if an input needs more memory than its size
// allows.
#pragma once

#include <cstdio>
#include <cstdlib>

#include "support/counting_new.h"
#include "support/heap_bound.h"

namespace vitrine::fuzz {

// Calls `run`, which handles an input of `bytes` bytes. Aborts if the heap memory that `run`
// allocates exceeds `bound` at any time.
template <class Run>
void bounded(const test::HeapBound& bound, std::size_t bytes, Run&& run) {
  const std::size_t before = test::heap_bytes();
  test::start_peak();
  run();
  const std::size_t held = test::peak_heap_bytes() - before;
  if (held <= bound.of(bytes)) return;
  std::fprintf(stderr, "heap: an input of %zu bytes held %zu bytes, %zu at most are allowed\n",
               bytes, held, bound.of(bytes));
  std::abort();
}

}  // namespace vitrine::fuzz
