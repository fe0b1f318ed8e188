// SPDX-License-Identifier: Apache-2.0
// Reads and writes integers, IEEE doubles and LEB128 variable-length integers. Numbers are
// little-endian unless stated otherwise.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace vitrine::inline codec {

static_assert(std::endian::native == std::endian::little);

// Loads a number of type T from the sizeof(T) bytes at `at`. The bytes are little-endian, or
// big-endian if `swap` is true.
template <class T>
T load(const std::uint8_t* at, bool swap = false) noexcept {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

// Reads numbers from untrusted bytes. A read beyond the end returns zero and makes is_ok() false
// permanently. One check after several reads is therefore enough.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes) {}

  bool is_ok() const noexcept { return is_ok_; }
  std::size_t position() const noexcept { return position_; }
  std::size_t left() const noexcept { return bytes_.size() - position_; }

  std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(fixed(1)); }
  std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(fixed(2)); }
  std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(fixed(4)); }
  std::uint64_t u64() noexcept { return fixed(8); }
  double f64() noexcept { return std::bit_cast<double>(u64()); }

  // Reads a number of type T: little-endian, or big-endian if `swap` is true.
  template <class T>
  T read(bool swap = false) noexcept {
    return take(sizeof(T)) ? load<T>(&bytes_[position_ - sizeof(T)], swap) : T{};
  }

  // Reads a LEB128 integer of 64 or 32 bits, which takes at most ten or five bytes. If the encoding
  // is longer or overflows, returns 0 and makes is_ok() false.
  std::uint64_t varint() noexcept { return leb128<64>(); }
  std::uint32_t varint32() noexcept { return static_cast<std::uint32_t>(leb128<32>()); }

  std::int64_t signed_varint() noexcept {  // zigzag-coded LEB128
    const std::uint64_t z = varint();
    return static_cast<std::int64_t>(z >> 1) ^ -static_cast<std::int64_t>(z & 1);
  }

  // Skips `count` bytes. If fewer bytes are left, skips all of them and makes is_ok() false.
  void skip(std::uint64_t count) noexcept {
    if (count > left()) is_ok_ = false;
    position_ += std::min<std::uint64_t>(count, left());
  }

  std::span<const std::uint8_t> bytes(std::size_t count) noexcept {
    if (!take(count)) return {};
    return bytes_.subspan(position_ - count, count);
  }

 private:
  bool take(std::size_t count) noexcept {
    if (!is_ok_ || left() < count) return is_ok_ = false;
    position_ += count;
    return true;
  }

  template <unsigned bits>
  std::uint64_t leb128() noexcept {
    constexpr unsigned kLastShift = bits / 7 * 7;
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift <= kLastShift; shift += 7) {
      const std::uint8_t byte = u8();
      if (shift == kLastShift && byte >> (bits - kLastShift) != 0) break;
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte < 0x80) return is_ok_ ? value : 0;
    }
    is_ok_ = false;
    return 0;
  }

  std::uint64_t fixed(std::size_t count) noexcept {
    if (!take(count)) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      value |= std::uint64_t{bytes_[position_ - count + i]} << (8 * i);
    }
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  bool is_ok_ = true;
};

class ByteWriter {
 public:
  void u8(std::uint8_t v) { out_.push_back(v); }
  void u16(std::uint16_t v) { fixed(v, 2); }
  void u32(std::uint32_t v) { fixed(v, 4); }
  void u64(std::uint64_t v) { fixed(v, 8); }
  void f64(double v) { u64(std::bit_cast<std::uint64_t>(v)); }
  void varint(std::uint64_t v) {
    for (; v >= 0x80; v >>= 7)
      u8(static_cast<std::uint8_t>(v | 0x80));
    u8(static_cast<std::uint8_t>(v));
  }
  void signed_varint(std::int64_t v) {
    varint(static_cast<std::uint64_t>(v) << 1 ^ static_cast<std::uint64_t>(v >> 63));
  }
  void bytes(std::span<const std::uint8_t> b) {
    // Appends byte by byte, because g++ 12 reports a false overflow warning at link time for
    // insert().
    for (const std::uint8_t v : b)
      u8(v);
  }

  std::size_t size() const { return out_.size(); }
  std::vector<std::uint8_t> take() { return std::move(out_); }

 private:
  void fixed(std::uint64_t v, int count) {
    for (int i = 0; i < count; ++i)
      out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }

  std::vector<std::uint8_t> out_;
};

}  // namespace vitrine::inline codec
