// SPDX-License-Identifier: Apache-2.0
#include "codec/export/bounds.h"

#include <algorithm>
#include <cmath>

namespace vitrine {
namespace {

constexpr double kFarthest = 16;  // in longest sides: 2^4 of the 2^24 steps of single precision

}  // namespace

Bounds bounds_of(const std::vector<Vec3>& positions) {
  Bounds box{positions[0], positions[0]};
  for (const Vec3& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

bool is_far_from_origin(const Bounds& bounds) {
  const Vec3 &a = bounds.low, &b = bounds.high;
  const double side = std::max({b.x - a.x, b.y - a.y, b.z - a.z});
  const double farthest = std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  return farthest > kFarthest * side;
}

}  // namespace vitrine
