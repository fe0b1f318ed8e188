// SPDX-License-Identifier: Apache-2.0
// A slice: the payload of one binary frame (PROTOCOL.md). It consists of a header and a part of a
// chunk or of a model's head.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace vitrine::server {

inline constexpr std::uint32_t kMaxSlice = 16 * 1024;

struct SliceHeader {
  std::uint16_t model = 0;   // the model's number in this connection
  std::uint16_t level = 0;   // level of the chunk; 0 for the model's head
  std::uint32_t region = 0;  // region of the chunk; 0 for the head
  std::uint32_t offset = 0;  // offset of the slice in the chunk or head
  std::uint32_t total = 0;   // length of the whole chunk or head
  bool operator==(const SliceHeader&) const = default;
};

inline constexpr std::size_t kSliceHeader = 16;
std::array<std::uint8_t, kSliceHeader> to_bytes(const SliceHeader& header);

// Parses the header of a frame. Returns nullopt unless the frame is a valid slice: 1 to kMaxSlice
// bytes follow the header, and none of them lies beyond `total`.
std::optional<SliceHeader> parse_slice(std::span<const std::uint8_t> frame);

struct Slice {
  SliceHeader header;
  std::uint64_t at = 0;      // offset of the slice's bytes in the model's file
  std::uint32_t length = 0;  // 1..kMaxSlice
  bool operator==(const Slice&) const = default;
};

}  // namespace vitrine::server
