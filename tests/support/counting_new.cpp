// SPDX-License-Identifier: Apache-2.0
#include "support/counting_new.h"
#include "support/product_names.h"

#include <sanitizer/asan_interface.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

// Each block is preceded by its size, at an offset that keeps the alignment of malloc. The address
// sanitizer reports any access to the size by a test.
constexpr std::size_t kPrefix = alignof(std::max_align_t);
std::size_t held = 0, peak = 0, calls = 0;
std::size_t until_failure = 0;  // allocations until one fails; 0: none fails

void* take(std::size_t size) noexcept {
  ++calls;
  if (until_failure > 0 && --until_failure == 0) return nullptr;
  auto* block = static_cast<std::size_t*>(std::malloc(size + kPrefix));
  if (block == nullptr) return nullptr;
  *block = size;
  held += size;
  peak = std::max(peak, held);
  ASAN_POISON_MEMORY_REGION(block, kPrefix);
  return reinterpret_cast<char*>(block) + kPrefix;
}

void* take_or_throw(std::size_t size) {
  if (void* p = take(size)) return p;
  throw std::bad_alloc();
}

void give_back(void* p) noexcept {
  if (p == nullptr) return;
  auto* block = reinterpret_cast<std::size_t*>(static_cast<char*>(p) - kPrefix);
  ASAN_UNPOISON_MEMORY_REGION(block, kPrefix);
  held -= *block;
  std::free(block);
}

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
std::size_t allocations() {
  return calls;
}
void fail_allocation(std::size_t n) {
  until_failure = n;
}

}  // namespace vitrine::test

// All forms of new are replaced, because the sanitizers' own forms do not call each other.
void* operator new(std::size_t size) {
  return take_or_throw(size);
}
void* operator new[](std::size_t size) {
  return take_or_throw(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return take(size);
}
void operator delete(void* p) noexcept {
  give_back(p);
}
void operator delete[](void* p) noexcept {
  give_back(p);
}
void operator delete(void* p, std::size_t) noexcept {
  give_back(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  give_back(p);
}
