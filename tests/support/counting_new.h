// SPDX-License-Identifier: Apache-2.0
// Counts the heap memory and the allocations through operator new in a test binary that links
// counting_new.cpp. Can also let an allocation fail.
#pragma once

#include <cstddef>

namespace vitrine::test {

std::size_t heap_bytes();       // bytes in use now
std::size_t peak_heap_bytes();  // largest number of bytes in use since start_peak()
void start_peak();
std::size_t allocations();  // allocations since the program started

// Lets allocation number `n`, counted from now, fail once. 0: no allocation fails.
void fail_allocation(std::size_t n);

}  // namespace vitrine::test
