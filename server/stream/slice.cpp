// SPDX-License-Identifier: Apache-2.0
#include "server/stream/slice.h"

namespace vitrine::server {
namespace {

template <class Value>
void put(std::uint8_t*& at, Value value) {
  for (std::size_t i = 0; i < sizeof value; ++i)
    *at++ = static_cast<std::uint8_t>(value >> (8 * i));
}

template <class Value>
void take(const std::uint8_t*& at, Value& value) {
  value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i)
    value = static_cast<Value>(value | static_cast<Value>(*at++) << (8 * i));
}

}  // namespace

std::array<std::uint8_t, kSliceHeader> to_bytes(const SliceHeader& header) {
  std::array<std::uint8_t, kSliceHeader> bytes{};
  std::uint8_t* at = bytes.data();
  put(at, header.model);
  put(at, header.level);
  put(at, header.region);
  put(at, header.offset);
  put(at, header.total);
  return bytes;
}

std::optional<SliceHeader> parse_slice(std::span<const std::uint8_t> frame) {
  if (frame.size() <= kSliceHeader || frame.size() > kSliceHeader + kMaxSlice) return std::nullopt;
  SliceHeader header;
  const std::uint8_t* at = frame.data();
  take(at, header.model);
  take(at, header.level);
  take(at, header.region);
  take(at, header.offset);
  take(at, header.total);
  const std::uint64_t end = std::uint64_t{header.offset} + (frame.size() - kSliceHeader);
  return end <= header.total ? std::optional(header) : std::nullopt;
}

}  // namespace vitrine::server
