// SPDX-License-Identifier: Apache-2.0
// Axis-aligned bounding boxes.
#pragma once

#include <algorithm>
#include <span>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

struct Bounds {
  Vec3 low, high;

  Vec3 centre() const { return (low + high) * 0.5; }
  double longest_side() const {
    const Vec3 side = high - low;
    return std::max({side.x, side.y, side.z});
  }
};

// Returns the bounding box of `positions`, which must not be empty.
inline Bounds bounds_of(std::span<const Vec3> positions) {
  Bounds box{positions[0], positions[0]};
  for (const Vec3& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

}  // namespace vitrine::inline codec
