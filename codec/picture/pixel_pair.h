// SPDX-License-Identifier: Apache-2.0
// Finds the pixels near a texture coordinate, along one axis.
#pragma once

#include <cmath>
#include <cstdint>

#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Maps the pixel index `i`, which may be out of range, to [0, size) according to `wrap`.
inline std::uint32_t wrapped_pixel(std::int64_t i, std::uint32_t size, Wrap wrap) {
  const std::int64_t n = size;
  if (i >= 0 && i < n) return static_cast<std::uint32_t>(i);
  if (wrap == Wrap::kClamp) return i < 0 ? 0 : size - 1;
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const std::int64_t at = (i % period + period) % period;
  return static_cast<std::uint32_t>(at < n ? at : 2 * n - 1 - at);
}

// Converts a texture coordinate to pixels. A coordinate becomes 0 if it is not finite, or so large
// that neighbouring pixels would have the same coordinate.
inline double in_pixels(double t, std::uint32_t size) {
  constexpr double kFar = 1e9;
  return (std::abs(t) < kFar ? t : 0) * size;
}

// Returns the largest integer that is at most `x`. |x| must be below 2^62. Avoids std::floor, which
// is a function call on processors without SSE 4.1.
inline std::int64_t floor_of(double x) {
  const auto towards_zero = static_cast<std::int64_t>(x);
  return towards_zero - (x < static_cast<double>(towards_zero) ? 1 : 0);
}

// Returns the pixel that contains coordinate `t`.
inline std::uint32_t pixel_at(double t, std::uint32_t size, Wrap wrap) {
  return wrapped_pixel(floor_of(in_pixels(t, size)), size, wrap);
}

// Two neighbouring pixels. The first has the weight 1 - `weight`, the second has `weight`.
struct PixelPair {
  std::uint32_t first, second;
  double weight;
};

// Returns the two pixels whose centres are nearest to coordinate `t`, one on each side.
inline PixelPair pixels_around(double t, std::uint32_t size, Wrap wrap) {
  const double x = in_pixels(t, size) - 0.5;
  const std::int64_t i = floor_of(x);
  return {wrapped_pixel(i, size, wrap), wrapped_pixel(i + 1, size, wrap),
          x - static_cast<double>(i)};
}

}  // namespace vitrine::inline codec
