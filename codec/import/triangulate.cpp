// SPDX-License-Identifier: Apache-2.0
#include "codec/import/triangulate.h"

#include <cmath>

namespace vitrine {
namespace {

struct Point {
  double u, v;
  std::uint32_t vertex;
};

// Twice the signed area of abc.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

// Newell's normal: robust for polygons that are not quite flat.
Vec3 newell_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
  Vec3 normal;
  const Vec3 origin = positions[polygon[0]];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    normal += cross(positions[polygon[i]] - origin,
                    positions[polygon[(i + 1) % polygon.size()]] - origin);
  }
  return normal;
}

// The polygon seen along its normal's longest axis, which keeps it counter-clockwise.
std::vector<Point> flatten(std::span<const Vec3> positions,
                           std::span<const std::uint32_t> polygon) {
  const Vec3 n = newell_normal(positions, polygon);
  const double ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
  std::vector<Point> points;
  points.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const Vec3& p = positions[v];
    Point q{p.x, p.y, v};
    double sign = n.z;
    if (ax >= ay && ax >= az) {
      q = {p.y, p.z, v}, sign = n.x;
    } else if (ay >= az) {
      q = {p.z, p.x, v}, sign = n.y;
    }
    if (sign < 0) std::swap(q.u, q.v);
    points.push_back(q);
  }
  return points;
}

bool is_convex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (area(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
  }
  return true;
}

bool is_ear(const std::vector<Point>& points, std::size_t i) {
  const std::size_t n = points.size();
  const Point &a = points[(i + n - 1) % n], &b = points[i], &c = points[(i + 1) % n];
  if (!(area(a, b, c) > 0)) return false;
  for (const Point& p : points) {
    if (p.vertex == a.vertex || p.vertex == b.vertex || p.vertex == c.vertex) continue;
    if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
  }
  return true;
}

void clip_ears(std::vector<Point> points, std::vector<Triangle>& triangles) {
  std::size_t i = 0, misses = 0;
  while (points.size() > 3) {
    const std::size_t n = points.size();
    // A polygon that crosses itself may run out of ears: then any corner will do.
    if (!is_ear(points, i) && ++misses <= n) {
      i = (i + 1) % n;
      continue;
    }
    triangles.push_back(
        {points[(i + n - 1) % n].vertex, points[i].vertex, points[(i + 1) % n].vertex});
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    i %= points.size();
    misses = 0;
  }
  triangles.push_back({points[0].vertex, points[1].vertex, points[2].vertex});
}

}  // namespace

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles) {
  if (polygon.size() > 3 && polygon.size() <= kMostClippedCorners) {
    std::vector<Point> points = flatten(positions, polygon);
    if (!is_convex(points)) return clip_ears(std::move(points), triangles);
  }
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
}

}  // namespace vitrine
