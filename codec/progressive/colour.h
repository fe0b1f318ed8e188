// SPDX-License-Identifier: Apache-2.0
// Colours of the hierarchy: integer YCoCg-R triples (Y, Co, Cg), which lift like positions. The
// merged triples of coarse levels may lie outside sRGB, so only the display clamps.
#pragma once

#include <algorithm>
#include <cstdint>

#include "codec/core/vec.h"

namespace vitrine {

// Lossless: from_ycocg(to_ycocg(c)) == c.
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

// The colour of v~.
constexpr Vec3i merge_colours(const Vec3i& c1, const Vec3i& c2) {
  return {(c1.x + c2.x) >> 1, (c1.y + c2.y) >> 1, (c1.z + c2.z) >> 1};
}

}  // namespace vitrine
