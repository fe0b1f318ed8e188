// SPDX-License-Identifier: Apache-2.0
// Entropy decoders of the Draco bitstream [Draco]: bits and symbols in range asymmetric numeral
// systems [Duda13], and plain bits. Internal to codec/base.
//
// The decoders are safe on any bytes. After a fault, is_ok() is false and all values are arbitrary.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/byte_cursor.h"

namespace vitrine::inline codec {

// Reads a length, which is a varint of up to 64 bits, and then that number of bytes. If fewer bytes
// are left, returns an empty span and makes in.is_ok() false.
std::span<const std::uint8_t> read_sized(ByteReader& in);

// The state of a range asymmetric numeral system decoder. It reads its data from the last byte to
// the first.
class RansState {
 public:
  // The state stays between `low` and 256 * `low` - 1. The initial state has 1 to `most` bytes.
  RansState(std::span<const std::uint8_t> bytes, std::uint32_t low, std::size_t most);

  bool is_ok() const { return is_ok_; }
  std::uint32_t get();
  void set(std::uint32_t state) { state_ = state; }

 private:
  std::span<const std::uint8_t> bytes_;  // bytes that have not been read
  std::uint32_t low_;
  std::uint32_t state_ = 0;
  bool is_ok_ = false;
};

// Decodes bits that all have the same probability of being 1.
class RansBits {
 public:
  explicit RansBits(ByteReader& in);

  bool is_ok() const { return state_.is_ok(); }
  bool next();

 private:
  std::uint8_t ones_;  // probability of a 1, in 256ths
  RansState state_;
};

// Decodes symbols. The table of their probabilities precedes the data.
class RansSymbols {
 public:
  // The probabilities add up to 2^p, where p is 1.5 * `bits`, clamped to the range from 12 to 20.
  RansSymbols(ByteReader& in, unsigned bits);

  bool is_ok() const { return is_ok_ && state_.is_ok(); }
  std::uint32_t next();

 private:
  bool read_table(ByteReader& in);

  unsigned precision_;  // probabilities are in units of 2^-precision_
  // first_[s] is the sum of the probabilities of all symbols before s. The last entry is the sum of
  // all probabilities.
  std::vector<std::uint32_t> first_;
  bool is_ok_;
  RansState state_;
};

// Reads uncompressed bits, the lowest bit of each byte first.
class PlainBits {
 public:
  explicit PlainBits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool is_ok() const { return is_ok_; }
  std::uint32_t next(unsigned count);  // reads 0 to 32 bits
  std::size_t bytes_read() const { return (position_ + 7) / 8; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;  // number of bits read so far
  bool is_ok_ = true;
};

// Returns `count` vectors of three integers that have been coded as symbols. Returns an empty list
// if the symbols are damaged. The memory needed depends on `count`, which the caller must bound.
std::vector<std::uint32_t> read_symbols(ByteReader& in, std::uint32_t count);

}  // namespace vitrine::inline codec
