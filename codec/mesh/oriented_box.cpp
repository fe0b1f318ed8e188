// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/oriented_box.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

// Bounds of rounding errors. kRounding: error of a coordinate along an axis, relative to the
// largest coordinate of the point. kSquaredRounding: relative error of a squared distance.
constexpr double kRounding = 1e-12, kSquaredRounding = 1e-9;

Vec3 unit(const Vec3& v) {
  return v * (1 / length(v));
}

// Returns the coordinate axis that is closest to perpendicular to `v`.
Vec3 most_perpendicular(const Vec3& v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

// Returns the unit vector perpendicular to the unit vector `u` in the plane of `u` and `v`.
// Orthogonalises twice, because one step is inaccurate if `u` and `v` are nearly parallel.
Vec3 perpendicular(const Vec3& u, Vec3 v) {
  constexpr double kParallel = 1e-6;
  v = v - u * dot(u, v);
  if (!(length(v) > 0)) return perpendicular(u, most_perpendicular(u));
  v = unit(v);
  const Vec3 again = v - u * dot(u, v);
  return length(again) > kParallel ? unit(again) : perpendicular(u, most_perpendicular(u));
}

}  // namespace

OrientedBox::OrientedBox(const TrianglePoints& t) {
  std::array<Vec3, 3> edge = {t.b - t.a, t.c - t.b, t.a - t.c};
  std::ranges::sort(edge, [](const Vec3& a, const Vec3& b) { return dot(a, a) > dot(b, b); });
  axis_[0] = dot(edge[0], edge[0]) > 0 ? unit(edge[0]) : Vec3{1, 0, 0};
  axis_[1] = perpendicular(axis_[0], edge[1]);
  axis_[2] = cross(axis_[0], axis_[1]);
}

void OrientedBox::add(const Vec3& p) {
  const double rounding = kRounding * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = dot(axis_[k], p);
    low_[k] = std::min(low_[k], at - rounding), high_[k] = std::max(high_[k], at + rounding);
  }
}

double OrientedBox::squared_distance(const Vec3& p, double slack) const {
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = dot(axis_[k], p);
    const double beyond = std::max({low_[k] - at - slack, at - high_[k] - slack, 0.0});
    squared += beyond * beyond;
  }
  return squared * (1 - kSquaredRounding);
}

}  // namespace vitrine::inline codec
