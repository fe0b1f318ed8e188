// SPDX-License-Identifier: Apache-2.0
// Upper bounds on everything that a file may ask us to allocate. A count is compared with these
// and with the bytes that are left before any memory is reserved for it.
#pragma once

#include <cstdint>

namespace vitrine {

struct Limits {
  std::uint64_t vertices = 100'000'000;
  std::uint64_t faces = 200'000'000;
  std::uint32_t levels = 64;
  std::uint32_t regions = 65'535;
  std::uint64_t header_bytes = 16u << 20;
};

inline constexpr int kMinBits = 10;
inline constexpr int kMaxBits = 16;
inline constexpr int kMaxSplitValence = 24;  // a split at a vertex of higher valence is an error

}  // namespace vitrine
