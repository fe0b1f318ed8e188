// SPDX-License-Identifier: Apache-2.0
// Converts between sRGB-coded values [sRGB] and linear light.
#pragma once

#include <cmath>

namespace vitrine::inline codec {

// Both functions map the range [0, 1] to itself.
inline double srgb_to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
inline double linear_to_srgb(double c) {
  return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

}  // namespace vitrine::inline codec
