// SPDX-License-Identifier: Apache-2.0
// A slice: a part of a chunk, or of a head, behind its header; the payload of one binary frame
// (PROTOCOL.md).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace vitrine {

inline constexpr std::uint32_t kMaxSlice = 16 * 1024;

struct SliceHeader {
  std::uint16_t model = 0;   // its number in this connection
  std::uint16_t level = 0;   // of the chunk; 0: the model's head
  std::uint32_t region = 0;  // of the chunk; 0 for the head
  std::uint32_t offset = 0;  // of the slice in the chunk
  std::uint32_t total = 0;   // length of the whole chunk
  bool operator==(const SliceHeader&) const = default;
};

inline constexpr std::size_t kSliceHeader = 16;
std::array<std::uint8_t, kSliceHeader> to_bytes(const SliceHeader& header);

// Of a whole frame; nothing where it is no slice: it has 1..kMaxSlice bytes behind the header, none
// of them beyond `total`.
std::optional<SliceHeader> parse_slice(std::span<const std::uint8_t> frame);

struct Slice {
  SliceHeader header;
  std::uint64_t at = 0;      // of its bytes in the model's file
  std::uint32_t length = 0;  // 1..kMaxSlice
  bool operator==(const Slice&) const = default;
};

}  // namespace vitrine
