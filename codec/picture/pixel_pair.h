// SPDX-License-Identifier: Apache-2.0
// The pixels of a picture around a texture coordinate, along one axis.
#pragma once

#include <cmath>
#include <cstdint>

#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Returns the index in [0, size) that stands for `i`.
inline std::uint32_t wrapped_pixel(std::int64_t i, std::uint32_t size, Wrap wrap) {
  const std::int64_t n = size;
  if (i >= 0 && i < n) return static_cast<std::uint32_t>(i);
  if (wrap == Wrap::kClamp) return i < 0 ? 0 : size - 1;
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const std::int64_t at = (i % period + period) % period;
  return static_cast<std::uint32_t>(at < n ? at : 2 * n - 1 - at);
}

// Returns coordinate `t` in pixels from the origin. Coordinates that are not finite, or so large
// that neighbouring pixels have the same coordinate, are treated as 0.
inline double in_pixels(double t, std::uint32_t size) {
  constexpr double kFar = 1e9;
  return (std::abs(t) < kFar ? t : 0) * size;
}

// Returns the largest whole number that is at most `x`, which must be below 2^62 in size. Without
// the call that std::floor is on processors without SSE 4.1.
inline std::int64_t floor_of(double x) {
  const auto towards_zero = static_cast<std::int64_t>(x);
  return towards_zero - (x < static_cast<double>(towards_zero) ? 1 : 0);
}

// Returns the pixel that contains coordinate `t`.
inline std::uint32_t pixel_at(double t, std::uint32_t size, Wrap wrap) {
  return wrapped_pixel(floor_of(in_pixels(t, size)), size, wrap);
}

// Two neighbouring pixels. `weight` is the weight of the second one.
struct PixelPair {
  std::uint32_t first, second;
  double weight;
};

// Returns the pixels whose centres lie around coordinate `t`.
inline PixelPair pixels_around(double t, std::uint32_t size, Wrap wrap) {
  const double x = in_pixels(t, size) - 0.5;
  const std::int64_t i = floor_of(x);
  return {wrapped_pixel(i, size, wrap), wrapped_pixel(i + 1, size, wrap),
          x - static_cast<double>(i)};
}

}  // namespace vitrine::inline codec
