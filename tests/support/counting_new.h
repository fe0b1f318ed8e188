// SPDX-License-Identifier: Apache-2.0
// Counts what a test binary that links counting_new.cpp holds on the heap through operator new and
// how often it asks for more, and lets that fail.
#pragma once

#include <cstddef>

namespace vitrine::test {

std::size_t heap_bytes();       // held now
std::size_t peak_heap_bytes();  // most held since start_peak()
void start_peak();
std::size_t allocations();  // calls so far

// The allocation that comes as number `n` from now on fails, once; with 0 none does.
void fail_allocation(std::size_t n);

}  // namespace vitrine::test
