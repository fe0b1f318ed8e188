// SPDX-License-Identifier: Apache-2.0
// Where malloc gets its memory from, in place of wasi-libc's own: that grows by 64 KiB at a time,
// and at each growth a browser collects its garbage. This one grows by a sixteenth at least.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kPage = 65536;
constexpr std::size_t kShare = 16;

bool grow(std::size_t pages) {
  return __builtin_wasm_memory_grow(0, pages) != SIZE_MAX;
}

}  // namespace

// `increment` is a multiple of a page: that is what wasi-libc's malloc asks for.
extern "C" void* sbrk(std::intptr_t increment) {
  static std::size_t end = __builtin_wasm_memory_size(0);  // pages that malloc has
  const std::size_t there = __builtin_wasm_memory_size(0);
  const std::size_t wanted = end + static_cast<std::size_t>(increment) / kPage;
  if (wanted > there && !grow(std::max(wanted - there, there / kShare)) && !grow(wanted - there)) {
    errno = ENOMEM;
    return reinterpret_cast<void*>(-1);
  }
  void* start = reinterpret_cast<void*>(end * kPage);
  end = wanted;
  return start;
}
