// SPDX-License-Identifier: Apache-2.0
// Codes an integer whose distribution is roughly a Gaussian of known centre and width: zero, sign,
// exponent, mantissa, each decision in a context of the width.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "codec/core/exact_math.h"
#include "codec/core/range_coder.h"

namespace vitrine {

class ResidualCoder {
 public:
  // Codes `value` given its expected `centre` and standard deviation `width` (> 0).
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t value, double centre, double width) {
    const std::int32_t whole = exact::round(centre);
    const double offset = std::clamp(centre - whole, -0.5, 0.5);
    const int w = std::clamp(exact::log2_bucket<2>(width) + 8, 0, kWidths - 1);
    const int side = std::clamp(static_cast<int>((offset + 0.5) * 5), 0, 4);
    const std::int32_t residual = Coder::kEncodes ? value - whole : 0;

    if (coder.bit(zero_[w][std::abs(side - 2)], residual == 0 ? 1 : 0) != 0) return whole;
    const bool negative = coder.bit(sign_[w / 2][side], residual < 0 ? 1 : 0) != 0;
    const auto magnitude = static_cast<std::uint32_t>(negative ? -residual : residual);
    const auto coded = static_cast<std::int32_t>(code_magnitude(coder, magnitude, w));
    return negative ? whole - coded : whole + coded;
  }

 private:
  static constexpr int kWidths = 48;     // width 2^-2 … 2^10 in quarter octaves
  static constexpr int kExponents = 21;  // magnitudes below 2^21

  template <class Coder>
  std::uint32_t code_magnitude(Coder& coder, std::uint32_t magnitude, int w) {  // >= 1
    const int wanted = Coder::kEncodes ? std::bit_width(magnitude) - 1 : 0;
    int exponent = 0;
    while (exponent < kExponents - 1 &&
           coder.bit(exponent_[w][exponent], exponent < wanted ? 1 : 0) != 0) {
      ++exponent;
    }
    std::uint32_t coded = 1;
    for (int place = exponent - 1; place >= 0; --place) {
      const auto bit = static_cast<int>(magnitude >> place & 1u);
      const int depth = exponent - 1 - place;
      coded =
          coded << 1 |
          static_cast<std::uint32_t>(
              depth < 2 ? coder.bit(mantissa_[w / 2][exponent][depth * 2 + (coded & depth)], bit)
                        : static_cast<int>(coder.raw(static_cast<std::uint32_t>(bit), 1)));
    }
    return coded;
  }

  std::array<std::array<AdaptiveBit, 3>, kWidths> zero_;
  std::array<std::array<AdaptiveBit, 5>, kWidths / 2> sign_;
  std::array<std::array<AdaptiveBit, kExponents>, kWidths> exponent_;
  std::array<std::array<std::array<AdaptiveBit, 4>, kExponents>, kWidths / 2> mantissa_;
};

}  // namespace vitrine
