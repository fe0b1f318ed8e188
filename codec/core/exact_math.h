// SPDX-License-Identifier: Apache-2.0
// The mathematical functions on which decoding depends. They use only the four basic operations and
// square roots of [IEEE754] and bit operations, so results are bit-identical on every machine. Code
// that includes this header must be compiled with -ffp-contract=off.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "codec/core/double2.h"

namespace vitrine::inline codec::exact {

// Equals std::floor if x is within the range of 32-bit integers. Avoids a library call.
inline std::int32_t floor(double x) {
  const auto towards_zero = static_cast<std::int32_t>(x);
  return towards_zero - (x < towards_zero ? 1 : 0);
}

// Equals std::floor for |x| < 2^51. Adding and then subtracting 1.5 * 2^52 rounds x to an integer.
inline Double2 floor(Double2 x) {
  constexpr double kNoFraction = 6755399441055744;
  const Double2 nearest = (x + kNoFraction) - kNoFraction;
  return nearest - (nearest > x ? both(1) : both(0));
}

// Returns e^x for x in [-40, 0], with an error of about 1e-9. Values below -40 are treated as -40.
inline Double2 exp_of_negative(Double2 x) {
  constexpr double kLog2e = 1.4426950408889634, kLn2 = 0.6931471805599453;
  const Double2 t = max(x, both(-40)) * kLog2e;
  const Double2 whole = exact::floor(t + 0.5);
  const Double2 f = (t - whole) * kLn2;  // |f| <= 0.35
  const Double2 series =
      1 +
      f * (1 + f * (1.0 / 2 +
                    f * (1.0 / 6 + f * (1.0 / 24 + f * (1.0 / 120 + f * (1.0 / 720 + f / 5040))))));
  // Adding 2^52 moves the biased exponent, whole + 1023, to the lowest bits of the double. The
  // shift then moves it to the exponent field.
  using Bits = std::uint64_t __attribute__((vector_size(16)));
  const auto exponent = std::bit_cast<Bits>(whole + (4503599627370496 + 1023.0));
  return series * std::bit_cast<Double2>(exponent << 52);
}

// Returns floor(2^kFractionBits * log2(x)) for x > 0. log2 is approximated by linear interpolation
// between powers of two.
template <int kFractionBits>
inline int log2_bucket(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return static_cast<int>(static_cast<std::int64_t>(bits >> (52 - kFractionBits)) -
                          (std::int64_t{1023} << kFractionBits));
}

// Rounds x to the nearest integer; halves round up. Clamps the result to [-2^20, 2^20]. NaN gives
// -2^20.
inline std::int32_t round(double x) {
  constexpr double kBound = 1 << 20;
  if (!(x > -kBound)) return -(1 << 20);
  if (x > kBound) return 1 << 20;
  return exact::floor(x + 0.5);
}

}  // namespace vitrine::inline codec::exact
