// SPDX-License-Identifier: Apache-2.0
#include "support/counting_new.h"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

// Each block is preceded by its size, in a place that keeps the alignment of malloc.
constexpr std::size_t kPrefix = alignof(std::max_align_t);
std::size_t held = 0, peak = 0;

}  // namespace

namespace vitrine::test {

std::size_t heap_bytes() {
  return held;
}
std::size_t peak_heap_bytes() {
  return peak;
}
void start_peak() {
  peak = held;
}

}  // namespace vitrine::test

void* operator new(std::size_t size) {
  auto* block = static_cast<std::size_t*>(std::malloc(size + kPrefix));
  if (block == nullptr) throw std::bad_alloc();
  *block = size;
  held += size;
  peak = std::max(peak, held);
  return reinterpret_cast<char*>(block) + kPrefix;
}

void operator delete(void* p) noexcept {
  if (p == nullptr) return;
  auto* block = reinterpret_cast<std::size_t*>(static_cast<char*>(p) - kPrefix);
  held -= *block;
  std::free(block);
}
void operator delete(void* p, std::size_t) noexcept {
  operator delete(p);
}
