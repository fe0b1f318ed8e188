// SPDX-License-Identifier: Apache-2.0
#include "codec/export/far_from_origin.h"

#include <cmath>

namespace vitrine {
namespace {

constexpr double kFarthest = 16;  // in longest sides: 2^4 of the 2^24 steps of single precision

}  // namespace

bool is_far_from_origin(const Bounds& bounds) {
  const Vec3 &a = bounds.low, &b = bounds.high;
  const double farthest = std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  return farthest > kFarthest * bounds.longest_side();
}

}  // namespace vitrine
