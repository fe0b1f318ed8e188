// SPDX-License-Identifier: Apache-2.0
// Upper bounds on the counts that a file may state. Readers check each count against these bounds
// and against the remaining bytes before they allocate memory.
#pragma once

#include <cstdint>

namespace vitrine::inline codec {

struct Limits {
  std::uint64_t vertices = 100'000'000;
  std::uint64_t faces = 200'000'000;
  std::uint32_t levels = 64;
  std::uint32_t regions = 65'535;
  std::uint64_t header_bytes = 16u << 20;
  std::uint64_t pixels = 1u << 28;         // total of all pictures of a mesh after decoding
  std::uint64_t picture_bytes = 1u << 30;  // total size of all picture files of a mesh
};

inline constexpr int kMinBits = 10;
inline constexpr int kMaxBits = 16;
inline constexpr int kMaxSplitValence = 24;  // only vertices with at most this valence may split

}  // namespace vitrine::inline codec
