// SPDX-License-Identifier: Apache-2.0
// A pair of doubles in one SIMD register (SSE2, NEON or WebAssembly SIMD). Each operation applies
// the IEEE operation to both elements, so the results are bit-identical to scalar code.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace vitrine::inline codec {

using Double2 = double __attribute__((vector_size(16)));

inline Double2 both(double x) {
  return Double2{x, x};
}
// Loads from[0] and from[1].
inline Double2 load2(const double* from) {
  Double2 v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store2(double* to, Double2 v) {
  std::memcpy(to, &v, sizeof v);
}

inline Double2 max(Double2 a, Double2 b) {
  return a > b ? a : b;
}
inline Double2 clamp(Double2 x, double low, double high) {
  x = x > low ? x : both(low);
  return x < high ? x : both(high);
}
inline Double2 abs(Double2 x) {
  return max(x, -x);
}
inline Double2 sqrt(Double2 x) {
#ifdef __SSE2__
  return _mm_sqrt_pd(x);
#else
  return Double2{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}

}  // namespace vitrine::inline codec
