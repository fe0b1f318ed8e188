// SPDX-License-Identifier: Apache-2.0
// Codes an integer that roughly follows a Gaussian distribution with known centre and standard
// deviation. First codes whether the integer equals the rounded centre, then the sign, exponent and
// mantissa of the difference. The contexts of these bits depend on the standard deviation.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "codec/core/exact_math.h"
#include "codec/core/range_coder.h"

namespace vitrine::inline codec {

class ResidualCoder {
 public:
  ResidualCoder();

  // Codes `value`, given its expected `centre` and its standard deviation `width` (> 0).
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t value, double centre, double width) {
    const std::int32_t whole = exact::round(centre);
    const double offset = std::clamp(centre - whole, -0.5, 0.5);
    const int w = std::clamp(exact::log2_bucket<2>(width) + 8, 0, kWidths - 1);
    const int side = std::clamp(static_cast<int>((offset + 0.5) * 5), 0, 4);
    const std::int32_t residual = Coder::kEncodes ? value - whole : 0;

    if (coder.bit(bits_[zero(w, std::abs(side - 2))], residual == 0 ? 1 : 0) != 0) return whole;
    const bool negative = coder.bit(bits_[sign(w, side)], residual < 0 ? 1 : 0) != 0;
    const auto magnitude = static_cast<std::uint32_t>(negative ? -residual : residual);
    const auto coded = static_cast<std::int32_t>(code_magnitude(coder, magnitude, w));
    return negative ? whole - coded : whole + coded;
  }

  static constexpr int kWidths = 48;  // classes of `width`, from 2^-2 to 2^10 in steps of 2^0.25
  // Number of exponents with a context of their own. Larger exponents share the last context.
  static constexpr int kExponents = 12;
  // Number of classes of the exponent relative to the width. The class selects the mantissa's
  // contexts.
  static constexpr int kRanges = 8;
  static constexpr std::size_t kBits =
      kWidths * 3 + kWidths / 2 * 5 + kWidths * kExponents + kRanges * 4;
  const std::array<AdaptiveBit, kBits>& bits() const { return bits_; }

 private:
  static constexpr int kMaxExponent = 20;  // magnitudes stay below 2^21

  static std::size_t index(int context) { return static_cast<std::size_t>(context); }
  static std::size_t zero(int w, int offset) { return index(w * 3 + offset); }
  static std::size_t sign(int w, int side) { return index(kWidths * 3 + w / 2 * 5 + side); }
  static std::size_t more(int w, int exponent) {
    return index(kWidths * 3 + kWidths / 2 * 5 + w * kExponents +
                 std::min(exponent, kExponents - 1));
  }
  static std::size_t mantissa(int w, int exponent, int node) {
    const int range = std::clamp(exponent - (w - 8) / 4 + 5, 0, kRanges - 1);
    return kBits - kRanges * 4 + index(range * 4 + node);
  }

  template <class Coder>
  // `magnitude` must be at least 1.
  std::uint32_t code_magnitude(Coder& coder, std::uint32_t magnitude, int w) {
    const int wanted = Coder::kEncodes ? std::bit_width(magnitude) - 1 : 0;
    int exponent = 0;
    while (exponent < kMaxExponent &&
           coder.bit(bits_[more(w, exponent)], exponent < wanted ? 1 : 0) != 0) {
      ++exponent;
    }
    std::uint32_t coded = 1;
    for (int place = exponent - 1; place >= 0; --place) {
      const auto bit = static_cast<int>(magnitude >> place & 1u);
      const int depth = exponent - 1 - place;
      const int node = depth == 0 ? 0 : static_cast<int>(2 + (coded & 1u));
      const int got = depth < 2 ? coder.bit(bits_[mantissa(w, exponent, node)], bit)
                                : static_cast<int>(coder.raw(static_cast<std::uint32_t>(bit), 1));
      coded = coded << 1 | static_cast<std::uint32_t>(got);
    }
    return coded;
  }

  std::array<AdaptiveBit, kBits> bits_;
};

}  // namespace vitrine::inline codec
