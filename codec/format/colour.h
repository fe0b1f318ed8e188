// SPDX-License-Identifier: Apache-2.0
// Vertex colours as integer YCoCg-R triples (Y, Co, Cg). Edge collapses average these triples like
// positions, so colours of coarse levels may lie outside sRGB. They are clamped only for display.
#pragma once

#include <algorithm>
#include <cstdint>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Converts sRGB to YCoCg-R without loss: from_ycocg(to_ycocg(c)) == c.
constexpr Vec3i to_ycocg(const Colour& c) {
  const std::int32_t orange = c[0] - c[2];
  const std::int32_t t = c[2] + (orange >> 1);
  const std::int32_t green = c[1] - t;
  return {t + (green >> 1), orange, green};
}

constexpr Colour from_ycocg(const Vec3i& c) {
  const std::int32_t t = c.x - (c.z >> 1);
  const std::int32_t blue = t - (c.y >> 1);
  const auto byte = [](std::int32_t v) {
    return static_cast<std::uint8_t>(std::clamp<std::int32_t>(v, 0, 255));
  };
  return {byte(blue + c.y), byte(c.z + t), byte(blue)};
}

}  // namespace vitrine::inline codec
