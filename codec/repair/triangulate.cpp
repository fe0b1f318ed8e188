// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/triangulate.h"

#include <algorithm>
#include <cmath>

#include "codec/repair/raw_mesh.h"
#include "codec/repair/triangulate.h"

namespace vitrine::inline codec {
namespace {

// Computes Newell's normal, which also works for polygons that are not quite flat.
Vec3 newell_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
  Vec3 normal;
  const Vec3 origin = positions[polygon[0]];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    normal += cross(positions[polygon[i]] - origin,
                    positions[polygon[(i + 1) % polygon.size()]] - origin);
  }
  return normal;
}

// Projects the polygon along the longest axis of its normal. The projected polygon is
// counter-clockwise.
std::vector<FlatCorner> flatten(std::span<const Vec3> positions,
                                std::span<const std::uint32_t> polygon) {
  const Vec3 n = newell_normal(positions, polygon);
  const double ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
  std::vector<FlatCorner> corners;
  corners.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const Vec3& p = positions[v];
    FlatCorner q{p.x, p.y, v};
    double sign = n.z;
    if (ax >= ay && ax >= az) {
      q.u = p.y, q.v = p.z, sign = n.x;
    } else if (ay >= az) {
      q.u = p.z, q.v = p.x, sign = n.y;
    }
    if (sign < 0) std::swap(q.u, q.v);
    corners.push_back(q);
  }
  return corners;
}

bool is_convex(std::span<const FlatCorner> polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (signed_area(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]) < 0) return false;
  }
  return true;
}

// Whether the polygon must be triangulated by ear clipping. Returns false if a corner's coordinates
// are not usable, because such a corner cannot be projected.
bool needs_clipping(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                    std::span<const FlatCorner> flat) {
  const auto usable = [&](std::uint32_t v) { return is_usable(positions[v]); };
  return std::ranges::all_of(polygon, usable) &&
         (polygon.size() > kMostFanCorners || !is_convex(flat));
}

}  // namespace

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles) {
  if (polygon.size() > 3) {
    const std::vector<FlatCorner> flat = flatten(positions, polygon);
    if (needs_clipping(positions, polygon, flat)) {
      clip_ears(flat, triangles);
      return;
    }
  }
  const auto corners = static_cast<std::uint32_t>(polygon.size());
  for (std::uint32_t i = 2; i < corners; ++i)
    triangles.push_back({0, i - 1, i});
}

}  // namespace vitrine::inline codec
