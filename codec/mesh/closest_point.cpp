// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/closest_point.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

Vec3 on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 ab = b - a;
  const double size = dot(ab, ab);
  return size > 0 ? a + ab * std::clamp(dot(p - a, ab) / size, 0.0, 1.0) : a;
}

}  // namespace

Vec3 closest_point_of_edges(const TrianglePoints& t, const Vec3& p) noexcept {
  Vec3 best = on_segment(t.a, t.b, p);
  for (const Vec3& q : {on_segment(t.b, t.c, p), on_segment(t.c, t.a, p)}) {
    if (dot(p - q, p - q) < dot(p - best, p - best)) best = q;
  }
  return best;
}

}  // namespace vitrine::inline codec
