// SPDX-License-Identifier: Apache-2.0
// Counts what a test binary that links counting_new.cpp holds on the heap through operator new.
#pragma once

#include <cstddef>

namespace vitrine::test {

std::size_t heap_bytes();       // held now
std::size_t peak_heap_bytes();  // most held since start_peak()
void start_peak();

}  // namespace vitrine::test
