// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/triangulate.h"

#include <cmath>

namespace vitrine::inline codec {
namespace {

struct ProjectedPoint {
  double u, v;
  std::uint32_t vertex;
  std::uint32_t corner;  // index into the polygon
};

// Returns twice the signed area of the triangle abc.
double area(const ProjectedPoint& a, const ProjectedPoint& b, const ProjectedPoint& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

// Computes Newell's normal, which is robust for polygons that are not quite flat.
Vec3 newell_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
  Vec3 normal;
  const Vec3 origin = positions[polygon[0]];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    normal += cross(positions[polygon[i]] - origin,
                    positions[polygon[(i + 1) % polygon.size()]] - origin);
  }
  return normal;
}

// Projects the polygon along the longest axis of its normal. The result is counter-clockwise.
std::vector<ProjectedPoint> flatten(std::span<const Vec3> positions,
                                    std::span<const std::uint32_t> polygon) {
  const Vec3 n = newell_normal(positions, polygon);
  const double ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
  std::vector<ProjectedPoint> points;
  points.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const Vec3& p = positions[v];
    ProjectedPoint q{p.x, p.y, v, static_cast<std::uint32_t>(points.size())};
    double sign = n.z;
    if (ax >= ay && ax >= az) {
      q.u = p.y, q.v = p.z, sign = n.x;
    } else if (ay >= az) {
      q.u = p.z, q.v = p.x, sign = n.y;
    }
    if (sign < 0) std::swap(q.u, q.v);
    points.push_back(q);
  }
  return points;
}

bool is_convex(const std::vector<ProjectedPoint>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (area(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
  }
  return true;
}

bool is_ear(const std::vector<ProjectedPoint>& points, std::size_t i) {
  const std::size_t n = points.size();
  const ProjectedPoint &a = points[(i + n - 1) % n], &b = points[i], &c = points[(i + 1) % n];
  if (!(area(a, b, c) > 0)) return false;
  for (const ProjectedPoint& p : points) {
    if (p.vertex == a.vertex || p.vertex == b.vertex || p.vertex == c.vertex) continue;
    if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
  }
  return true;
}

void clip_ears(std::vector<ProjectedPoint> points, std::vector<Triangle>& triangles) {
  std::size_t i = 0, misses = 0;
  while (points.size() > 3) {
    const std::size_t n = points.size();
    // A self-intersecting polygon may run out of ears. In that case any corner is cut off.
    if (!is_ear(points, i) && ++misses <= n) {
      i = (i + 1) % n;
      continue;
    }
    triangles.push_back(
        {points[(i + n - 1) % n].corner, points[i].corner, points[(i + 1) % n].corner});
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    i %= points.size();
    misses = 0;
  }
  triangles.push_back({points[0].corner, points[1].corner, points[2].corner});
}

}  // namespace

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles) {
  if (polygon.size() > 3 && polygon.size() <= kMostClippedCorners) {
    std::vector<ProjectedPoint> points = flatten(positions, polygon);
    if (!is_convex(points)) return clip_ears(std::move(points), triangles);
  }
  const auto corners = static_cast<std::uint32_t>(polygon.size());
  for (std::uint32_t i = 2; i < corners; ++i)
    triangles.push_back({0, i - 1, i});
}

}  // namespace vitrine::inline codec
