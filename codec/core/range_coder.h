// SPDX-License-Identifier: Apache-2.0
// Adaptive binary range coder [Martin79]. Output bytes are held back until no carry can change them
// any more.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrine::inline codec {

// An adaptive estimate of the probability that a bit is 1, in units of 1/65536. Each coded bit
// moves the estimate towards 0 or 1 by 1/(n + 1.5) of the distance, where n is the smaller of
// kLimit and the number of earlier bits.
struct AdaptiveBit {
  static constexpr int kLimit = 160;

  std::uint16_t one = 32768;
  std::uint8_t seen = 0;

  void update(int bit) {
    const std::int32_t target = bit != 0 ? 65535 - 24 : 24;
    const std::int32_t delta = target - one;
    one = static_cast<std::uint16_t>(one + ((delta * kStep[seen]) >> 16));
    seen = static_cast<std::uint8_t>(seen + static_cast<int>(seen < kLimit));
  }

 private:
  static constexpr std::array<std::uint16_t, kLimit + 1> kStep = [] {
    std::array<std::uint16_t, kLimit + 1> step{};
    for (int n = 0; n <= kLimit; ++n)
      step[n] = static_cast<std::uint16_t>(131072 / (2 * n + 3));
    return step;
  }();
};

namespace range_coder {
inline constexpr std::uint32_t kTop = 1u << 24;
// Returns the part of `range` that codes a 1. This part is never empty and never the whole range.
constexpr std::uint32_t share(std::uint32_t range, std::uint16_t one) {
  return (range >> 16) * (one | 1u);
}
}  // namespace range_coder

class RangeEncoder {
 public:
  static constexpr bool kEncodes = true;

  int bit(AdaptiveBit& model, int value) {
    const std::uint32_t bound = range_coder::share(range_, model.one);
    if (value != 0) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    model.update(value);
    while (range_ < range_coder::kTop)
      range_ <<= 8, shift();
    return value;
  }

  // Codes `count` bits of `value` with equal probabilities, most significant bit first.
  std::uint32_t raw(std::uint32_t value, int count) {
    while (count-- > 0) {
      range_ >>= 1;
      if ((value >> count & 1u) == 0) low_ += range_;
      while (range_ < range_coder::kTop)
        range_ <<= 8, shift();
    }
    return value;
  }

  // Ends the stream and returns its bytes, without trailing zero bytes. The decoder reads zeros
  // beyond the end.
  std::vector<std::uint8_t> finish() {
    for (int i = 0; i < 5; ++i)
      shift();
    while (!out_.empty() && out_.back() == 0)
      out_.pop_back();
    return std::move(out_);
  }

 private:
  void shift() {
    if (low_ < 0xFF00'0000u || low_ > 0xFFFF'FFFFu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      if (has_started_) out_.push_back(static_cast<std::uint8_t>(pending_ + carry));
      for (; run_ > 0; --run_)
        out_.push_back(static_cast<std::uint8_t>(0xFF + carry));
      pending_ = static_cast<std::uint8_t>(low_ >> 24);
      has_started_ = true;
    } else {
      ++run_;
    }
    low_ = (low_ & 0x00FF'FFFFu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFF'FFFFu;
  std::uint8_t pending_ = 0;
  bool has_started_ = false;
  std::uint64_t run_ = 0;
  std::vector<std::uint8_t> out_;
};

class RangeDecoder {
 public:
  static constexpr bool kEncodes = false;

  explicit RangeDecoder(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes) {
    for (int i = 0; i < 4; ++i)
      code_ = code_ << 8 | take();
  }

  int bit(AdaptiveBit& model, int = 0) noexcept {
    const std::uint32_t bound = range_coder::share(range_, model.one);
    const int value = code_ < bound ? 1 : 0;
    if (value != 0) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    model.update(value);
    while (range_ < range_coder::kTop)
      range_ <<= 8, code_ = code_ << 8 | take();
    return value;
  }

  std::uint32_t raw(std::uint32_t, int count) noexcept {
    std::uint32_t value = 0;
    while (count-- > 0) {
      range_ >>= 1;
      const bool one = code_ < range_;
      if (!one) code_ -= range_;
      value = value << 1 | (one ? 1u : 0u);
      while (range_ < range_coder::kTop)
        range_ <<= 8, code_ = code_ << 8 | take();
    }
    return value;
  }

 private:
  std::uint8_t take() noexcept { return position_ < bytes_.size() ? bytes_[position_++] : 0; }

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  std::uint32_t range_ = 0xFFFF'FFFFu;
  std::uint32_t code_ = 0;
};

}  // namespace vitrine::inline codec
