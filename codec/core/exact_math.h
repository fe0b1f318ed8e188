// SPDX-License-Identifier: Apache-2.0
// The few functions that steer decoding beyond + - x / sqrt, built from these and from bit
// operations so that every machine computes the same bits. Compile with -ffp-contract=off.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace vitrine::exact {

// The same as std::floor for x within the range of 32 bits, and no call.
inline std::int32_t floor(double x) {
  const auto towards_zero = static_cast<std::int32_t>(x);
  return towards_zero - (x < towards_zero ? 1 : 0);
}

// e^x for x in [-40, 40] (clamped), to about 1e-9.
inline double exp(double x) {
  constexpr double kLog2e = 1.4426950408889634, kLn2 = 0.6931471805599453;
  const double t = std::clamp(x, -40.0, 40.0) * kLog2e;
  const std::int32_t whole = exact::floor(t + 0.5);
  const double f = (t - whole) * kLn2;  // |f| <= 0.35
  const double series =
      1 +
      f * (1 + f * (1.0 / 2 +
                    f * (1.0 / 6 + f * (1.0 / 24 + f * (1.0 / 120 + f * (1.0 / 720 + f / 5040))))));
  const auto exponent = static_cast<std::uint64_t>(std::int64_t{1023} + whole);
  return series * std::bit_cast<double>(exponent << 52);
}

// floor(2^fraction_bits * log2(x)), log2 linear between powers of two; x > 0.
template <int kFractionBits>
inline int log2_bucket(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return static_cast<int>(static_cast<std::int64_t>(bits >> (52 - kFractionBits)) -
                          (std::int64_t{1023} << kFractionBits));
}

// Rounds half up; everything outside +-2^20, and NaN, becomes the nearer bound.
inline std::int32_t round(double x) {
  constexpr double kBound = 1 << 20;
  if (!(x > -kBound)) return -(1 << 20);
  if (x > kBound) return 1 << 20;
  return exact::floor(x + 0.5);
}

}  // namespace vitrine::exact
