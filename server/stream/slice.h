// SPDX-License-Identifier: Apache-2.0
// A slice: a part of a chunk behind its header, the payload of one binary frame (PROTOCOL.md).
#pragma once

#include <array>
#include <cstdint>

#include "codec/progressive/manifest.h"

namespace vitrine {

inline constexpr std::uint32_t kMaxSlice = 16 * 1024;

struct Slice {
  std::size_t chunk = 0;     // index into the manifest's chunks
  std::uint32_t offset = 0;  // in the chunk
  std::uint32_t length = 0;  // 1..kMaxSlice
  bool operator==(const Slice&) const = default;
};

using SliceHeader = std::array<std::uint8_t, 12>;
SliceHeader slice_header(const ChunkInfo& chunk, const Slice& slice);

}  // namespace vitrine
