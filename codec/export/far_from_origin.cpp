// SPDX-License-Identifier: Apache-2.0
#include "codec/export/far_from_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrine::inline codec {
namespace {

// A mesh counts as far from the origin if a coordinate exceeds this many times the longest side of
// its bounding box. Single precision rounds a coordinate by at most 2^-24 of its value. For meshes
// that are not far from the origin, the error is therefore at most 2^-20 of the longest side.
constexpr double kFarthest = 16;

double farthest(const Bounds& bounds) {
  const Vec3 &a = bounds.low, &b = bounds.high;
  return std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
}

}  // namespace

bool is_far_from_origin(const Bounds& bounds) {
  return farthest(bounds) > kFarthest * bounds.longest_side();
}

double most_rounding(const Bounds& bounds) {
  const auto coordinate = static_cast<float>(farthest(bounds));
  return (std::nextafter(coordinate, std::numeric_limits<float>::infinity()) - coordinate) / 2;
}

}  // namespace vitrine::inline codec
