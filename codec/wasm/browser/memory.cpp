// SPDX-License-Identifier: Apache-2.0
// Memory functions that compile to single WebAssembly instructions. They replace the loops of
// wasi-libc.
#include <cstring>

extern "C" {
void* memcpy(void* to, const void* from, std::size_t size) {
  return __builtin_memcpy(to, from, size);
}
void* memmove(void* to, const void* from, std::size_t size) {
  return __builtin_memmove(to, from, size);
}
void* memset(void* to, int value, std::size_t size) {
  return __builtin_memset(to, value, size);
}
}
