// SPDX-License-Identifier: Apache-2.0
// The distance from a point to a triangle. The code is inline because distance queries spend nearly
// all their time here.
#pragma once

#include "codec/core/vec.h"

namespace vitrine::inline codec {

struct TrianglePoints {
  Vec3 a, b, c;
};

inline const Vec3& corner(const TrianglePoints& t, std::uint32_t k) noexcept {
  return k == 0 ? t.a : k == 1 ? t.b : t.c;
}

// Returns the normal vector of the triangle. Its length is twice the triangle's area.
inline Vec3 normal_of(const TrianglePoints& t) noexcept {
  return cross(t.b - t.a, t.c - t.a);
}

// Returns the point on the triangle's three edges that is closest to `p`.
Vec3 closest_point_of_edges(const TrianglePoints& triangle, const Vec3& p) noexcept;

// Returns the point of the triangle closest to `p`. Finds the Voronoi region of the triangle that
// contains `p` ([Ericson05] section 5.1.5). Triangles without area are treated as segments or
// points.
inline Vec3 closest_point(const TrianglePoints& t, const Vec3& p) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const Vec3 bp = p - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.b;
  const Vec3 cp = p - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.c;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 > 0 && d3 < 0) return t.a + ab * (d1 / (d1 - d3));
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 > 0 && d6 < 0) return t.a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4, e = d4 - d3, f = d5 - d6;
  if (va <= 0 && e > 0 && f > 0) return t.b + (t.c - t.b) * (e / (e + f));
  const double area = va + vb + vc;
  if (!(area > 0)) return closest_point_of_edges(t, p);
  return t.a + ab * (vb / area) + ac * (vc / area);
}

inline double squared_distance(const TrianglePoints& triangle, const Vec3& p) noexcept {
  const Vec3 d = p - closest_point(triangle, p);
  return dot(d, d);
}

}  // namespace vitrine::inline codec
