// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/ray_cast.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vitrine::acquisition {
namespace {

// Whether a ray meets the box, by the slab test ([KK86]). `inverse` is 1 / direction for each
// component, which may be infinite.
bool meets_box(const TriangleBvh::Node& box, const Vec3& origin, const Vec3& inverse) {
  const std::array from = {origin.x, origin.y, origin.z}, per = {inverse.x, inverse.y, inverse.z};
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (box.low[k] - from[k]) * per[k], b = (box.high[k] - from[k]) * per[k];
    // If the ray is parallel to a side of the box and lies in it, 0 times infinity gives a NaN. In
    // the low side, the NaN changes nothing. In the high side, the ray misses the box, and with it
    // only triangles that it would graze.
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

// Uses the algorithm of [MT97].
bool meets_triangle(const TrianglePoints& t, const Vec3& origin, const Vec3& direction) {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, p = cross(direction, ac);
  const double determinant = dot(ab, p);
  if (determinant == 0) return false;
  const Vec3 s = origin - t.a, q = cross(s, ab);
  const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && dot(ac, q) / determinant > 0;
}

}  // namespace

bool hits(const TriangleBvh& surface, const Vec3& origin, const Vec3& direction) {
  const Vec3 inverse = {1 / direction.x, 1 / direction.y, 1 / direction.z};
  std::array<std::uint32_t, 64> stack;  // 64 suffice, because the tree is balanced
  std::size_t size = 0;
  if (!surface.empty()) stack[size++] = 0;
  while (size > 0) {
    const TriangleBvh::Node& node = surface.nodes()[stack[--size]];
    if (!meets_box(node, origin, inverse)) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (meets_triangle(surface.triangle(i), origin, direction)) return true;
    }
    if (node.count > 0) continue;
    stack[size++] = node.first + 1;
    stack[size++] = node.first;
  }
  return false;
}

}  // namespace vitrine::acquisition
