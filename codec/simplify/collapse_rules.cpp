// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/collapse_rules.h"

#include "codec/format/placement.h"

namespace vitrine::inline codec {
namespace {

// Minimum cosine of the angle between the normals of a face before and after a collapse.
constexpr double kLeastCosine = 0.2;

bool has_valence_3(const Connectivity& mesh, Corner c) {
  const VertexId v = mesh.vertex(c);
  if (is_virtual(v)) return mesh.loop_length(v) == 3;
  return mesh.swing(mesh.swing(mesh.swing(c))) == c;
}

std::uint32_t common_neighbours(const Star& a, const Star& b) {
  std::uint32_t count = 0;
  for (VertexId v : a.neighbours()) {
    for (VertexId w : b.neighbours())
      count += v == w;
  }
  return count;
}

bool face_survives(const Vec3& centre, const Vec3& a, const Vec3& b, const Vec3& target) {
  const Vec3 side = b - a;
  const Vec3 before = cross(a - centre, side), after = cross(a - target, side);
  const double size = dot(before, before);
  if (size == 0) return true;
  const double turn = dot(before, after);
  return turn > 0 && turn * turn > kLeastCosine * kLeastCosine * size * dot(after, after);
}

bool fan_survives(const Surface& surface, const Star& star, VertexId centre, VertexId other,
                  const Vec3& target) {
  const Vec3 from = surface.point(centre);
  VertexId a = star.vertex[star.valence - 1];
  for (VertexId b : star.neighbours()) {
    const bool stays = a != other && b != other && !is_virtual(a) && !is_virtual(b);
    if (stays && !face_survives(from, surface.point(a), surface.point(b), target)) return false;
    a = b;
  }
  return true;
}

}  // namespace

Star::Star(const Connectivity& mesh, VertexId v) {
  valence = mesh.ring(v, corner);
  for (std::uint32_t i = 0; i < valence; ++i) {
    vertex[i] = mesh.neighbour(corner[i]);
    is_on_border |= is_virtual(vertex[i]);
  }
}

EdgeStar::EdgeStar(const Connectivity& mesh, Corner c)
    : v1(mesh.vertex(c)),
      v2(mesh.neighbour(c)),
      apex12(mesh.vertex(prev(c))),
      apex21(mesh.vertex(mesh.opposite(prev(c)))),
      star1(mesh, v1),
      star2(mesh, v2) {}

bool keeps_manifold(const Connectivity& mesh, const EdgeStar& edge) {
  const Star &a = edge.star1, &b = edge.star2;
  if (a.valence == 0 || b.valence == 0 || a.valence + b.valence > kMaxSplitValence + 4)
    return false;
  const bool border_edge = is_virtual(edge.apex12) || is_virtual(edge.apex21);
  if (a.is_on_border && b.is_on_border && !border_edge) return false;
  if (common_neighbours(a, b) != 2) return false;
  for (std::uint32_t i = 0; i < a.valence; ++i) {
    if (a.vertex[i] != edge.v2) continue;
    const Corner apex12 = prev(a.corner[i]);
    return !has_valence_3(mesh, apex12) && !has_valence_3(mesh, mesh.opposite(apex12));
  }
  return false;
}

Vec3i merged_position(const Surface& surface, const EdgeStar& edge, Placement placement,
                      std::int32_t parity) {
  const Vec3i &p1 = surface.position[edge.v1], &p2 = surface.position[edge.v2];
  if (placement == Placement::kMidpoint) return merge(p1, p2, midpoint_term(parity));
  std::array<Vec3i, 2> opposite;
  std::array<Vec3i, 2 * Star::kCapacity> others;
  std::uint32_t m = 0, n = 0;
  for (VertexId apex : {edge.apex12, edge.apex21}) {
    if (!is_virtual(apex)) opposite[m++] = surface.position[apex];
  }
  const auto is_other = [&](VertexId v) {
    return !is_virtual(v) && v != edge.v1 && v != edge.v2 && v != edge.apex12 && v != edge.apex21;
  };
  for (const Star* star : {&edge.star1, &edge.star2}) {
    for (VertexId v : star->neighbours()) {
      if (is_other(v)) others[n++] = surface.position[v];
    }
  }
  return merge(p1, p2, pyramid_term({opposite.data(), m}, {others.data(), n}, parity));
}

bool keeps_orientation(const Surface& surface, const EdgeStar& edge, const Vec3i& target) {
  const Vec3 to = surface.middle(target);
  return fan_survives(surface, edge.star1, edge.v1, edge.v2, to) &&
         fan_survives(surface, edge.star2, edge.v2, edge.v1, to);
}

}  // namespace vitrine::inline codec
