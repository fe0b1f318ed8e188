// SPDX-License-Identifier: Apache-2.0
// Functions that several fuzzers share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace vitrine::fuzz {

// Aborts the run if `condition` is false. The fuzzer then reports the input, as it does if a
// sanitizer finds a fault.
inline void require(bool condition) {
  if (!condition) std::abort();
}

// Returns `length` bytes from `offset` on, or fewer if `bytes` ends earlier.
inline std::span<const std::uint8_t> part(std::span<const std::uint8_t> bytes, std::uint64_t offset,
                                          std::uint64_t length) {
  const std::uint64_t from = std::min<std::uint64_t>(offset, bytes.size());
  return bytes.subspan(from, std::min<std::uint64_t>(length, bytes.size() - from));
}

}  // namespace vitrine::fuzz
