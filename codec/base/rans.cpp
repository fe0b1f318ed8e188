// SPDX-License-Identifier: Apache-2.0
#include "codec/base/rans.h"

#include <algorithm>

namespace vitrine::inline codec {

std::span<const std::uint8_t> read_sized(ByteReader& in) {
  const std::uint64_t length = in.varint();
  return in.bytes(static_cast<std::size_t>(std::min<std::uint64_t>(length, in.left() + 1)));
}

RansState::RansState(std::span<const std::uint8_t> bytes, std::uint32_t low, std::size_t most)
    : bytes_(bytes), low_(low) {
  if (bytes_.empty()) return;
  // The last byte holds the initial state's highest six bits. Its own two highest bits are the
  // number of preceding bytes that also belong to the initial state.
  const std::size_t more = bytes_.back() >> 6;
  if (more >= std::min(bytes_.size(), most)) return;
  state_ = bytes_.back() & 0x3Fu;
  bytes_ = bytes_.first(bytes_.size() - 1);
  for (std::size_t i = 0; i < more; ++i) {
    state_ = state_ << 8 | bytes_.back();
    bytes_ = bytes_.first(bytes_.size() - 1);
  }
  state_ += low_;
  is_ok_ = state_ < 256 * low_;
}

std::uint32_t RansState::get() {
  while (state_ < low_ && !bytes_.empty()) {
    state_ = state_ << 8 | bytes_.back();
    bytes_ = bytes_.first(bytes_.size() - 1);
  }
  return state_;
}

RansBits::RansBits(ByteReader& in)
    : ones_(static_cast<std::uint8_t>(256 - in.u8())), state_(in.bytes(in.varint32()), 4096, 3) {}

bool RansBits::next() {
  const std::uint32_t state = state_.get(), rest = state % 256;
  const bool bit = rest < ones_;
  state_.set(bit ? state / 256 * ones_ + rest : state - state / 256 * ones_ - ones_);
  return bit;
}

RansSymbols::RansSymbols(ByteReader& in, unsigned bits)
    : precision_(std::clamp(3 * bits / 2, 12u, 20u)),
      is_ok_(read_table(in)),
      state_(read_sized(in), 4u << precision_, 4) {}

// Reads the probabilities of all symbols. Each entry of the table starts with a byte. If its two
// lowest bits are 3, its other six bits plus 1 are the number of successive symbols that do not
// occur. Otherwise, these six bits start a probability, and the two lowest bits are the number of
// bytes that continue it.
bool RansSymbols::read_table(ByteReader& in) {
  first_ = {0};
  const std::uint32_t symbols = in.varint32();
  while (in.is_ok() && first_.size() <= symbols) {
    const std::uint8_t byte = in.u8();
    if ((byte & 3) == 3) {
      const std::uint32_t sum = first_.back();
      first_.insert(first_.end(), (byte >> 2) + std::size_t{1}, sum);
      continue;
    }
    std::uint32_t probability = byte >> 2;
    for (unsigned k = 0; k < (byte & 3u); ++k)
      probability |= std::uint32_t{in.u8()} << (8 * k + 6);
    first_.push_back(first_.back() + probability);
    if (first_.back() > 1u << precision_) return false;
  }
  return in.is_ok() && first_.size() == symbols + 1 && first_.back() == 1u << precision_;
}

std::uint32_t RansSymbols::next() {
  const std::uint32_t state = state_.get(), rest = state & ((1u << precision_) - 1);
  const auto end = std::upper_bound(first_.begin(), first_.end(), rest);
  state_.set((state >> precision_) * (end[0] - end[-1]) + rest - end[-1]);
  return static_cast<std::uint32_t>(end - first_.begin() - 1);
}

std::uint32_t PlainBits::next(unsigned count) {
  if (count > 32 || count > 8 * bytes_.size() - position_) {
    is_ok_ = false;
    return 0;
  }
  std::uint32_t value = 0;
  for (unsigned i = 0; i < count; ++i, ++position_)
    value |= (bytes_[position_ / 8] >> position_ % 8 & 1u) << i;
  return value;
}

namespace {

// Reads vectors in Draco's "tagged" coding. For each vector, a symbol gives the number of bits of
// each component. The bits themselves follow after the symbols of all vectors.
std::vector<std::uint32_t> read_tagged(ByteReader& in, std::uint32_t count) {
  RansSymbols lengths(in, 5);
  if (!lengths.is_ok()) return {};
  ByteReader ahead = in;
  PlainBits bits(ahead.bytes(ahead.left()));
  std::vector<std::uint32_t> out;
  out.reserve(3 * std::size_t{count});
  for (std::uint32_t i = 0; i < count; ++i) {
    const unsigned length = lengths.next();
    for (int k = 0; k < 3; ++k)
      out.push_back(bits.next(length));
  }
  in.skip(bits.bytes_read());
  return bits.is_ok() ? out : std::vector<std::uint32_t>();
}

std::vector<std::uint32_t> read_raw(ByteReader& in, std::uint32_t count) {
  const unsigned bits = in.u8();
  if (bits < 1 || bits > 18) return {};
  RansSymbols symbols(in, bits);
  if (!symbols.is_ok()) return {};
  std::vector<std::uint32_t> out(3 * std::size_t{count});
  for (std::uint32_t& value : out)
    value = symbols.next();
  return out;
}

}  // namespace

std::vector<std::uint32_t> read_symbols(ByteReader& in, std::uint32_t count) {
  constexpr std::uint8_t kTagged = 0, kRaw = 1;
  const std::uint8_t scheme = in.u8();
  if (!in.is_ok() || scheme > kRaw) return {};
  return scheme == kTagged ? read_tagged(in, count) : read_raw(in, count);
}

}  // namespace vitrine::inline codec
