// SPDX-License-Identifier: Apache-2.0
// Colours in linear light. Unlike sRGB values, these can be multiplied and averaged.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

using LinearColour = std::array<double, 3>;  // red, green and blue, each 0 to 1

// Converts a colour component from [0, 1] to 0..255. Clamps values outside this range; NaN becomes
// 0.
inline std::uint8_t to_byte(double unit) {
  if (!(unit > 0)) return 0;
  return static_cast<std::uint8_t>(std::min(unit, 1.0) * 255 + 0.5);
}

LinearColour to_linear(const Colour& srgb);
Colour to_srgb(const LinearColour& linear);  // clamps to [0, 1]; NaN becomes 0

inline LinearColour operator*(const LinearColour& a, const LinearColour& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
inline LinearColour operator*(const LinearColour& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline LinearColour operator+(const LinearColour& a, const LinearColour& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

// Computes the mean colour of each vertex from samples.
class ColourMeans {
 public:
  explicit ColourMeans(std::size_t vertices = 0) { resize(vertices); }

  void resize(std::size_t vertices) { sums_.resize(vertices), counts_.resize(vertices); }
  bool empty() const { return sums_.empty(); }
  void add(std::size_t vertex, const LinearColour& colour) {
    sums_[vertex] = sums_[vertex] + colour;
    ++counts_[vertex];
  }
  std::vector<Colour> take() const;  // mean colour per vertex; white if it has no samples

 private:
  std::vector<LinearColour> sums_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace vitrine::inline codec
