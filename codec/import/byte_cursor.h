// SPDX-License-Identifier: Apache-2.0
// Walks over binary numbers; reading past the end gives zeros and is remembered.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace vitrine {

static_assert(std::endian::native == std::endian::little);

// Reads a little-endian (or, with `swap`, big-endian) number. `at` must have sizeof(T) bytes.
template <class T>
T load(const std::uint8_t* at, bool swap = false) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, at, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  return std::bit_cast<T>(bytes);
}

class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::uint8_t> bytes)
      : at_(bytes.data()), end_(at_ + bytes.size()) {}

  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  bool overrun() const { return overrun_; }

  template <class T>
  T read(bool swap = false) {
    if (left() < sizeof(T)) return overrun_ = true, T{};
    const T value = load<T>(at_, swap);
    at_ += sizeof(T);
    return value;
  }

  void skip(std::uint64_t bytes) {
    if (bytes > left()) overrun_ = true, bytes = left();
    at_ += bytes;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  bool overrun_ = false;
};

}  // namespace vitrine
