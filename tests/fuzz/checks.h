// SPDX-License-Identifier: Apache-2.0
// What fuzzers of `.pmesh` bytes share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace vitrine::fuzz {

// A fault that the sanitisers would not see ends the run as one of theirs does.
inline void require(bool condition) {
  if (!condition) std::abort();
}

// As much of a range as there is.
inline std::span<const std::uint8_t> part(std::span<const std::uint8_t> bytes, std::uint64_t offset,
                                          std::uint64_t length) {
  const std::uint64_t from = std::min<std::uint64_t>(offset, bytes.size());
  return bytes.subspan(from, std::min<std::uint64_t>(length, bytes.size() - from));
}

}  // namespace vitrine::fuzz
