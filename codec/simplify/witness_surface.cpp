// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/witness_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/mesh/face_neighbours.h"

namespace vitrine {
namespace {

constexpr int kMaxSteps = 64;  // of a walk
constexpr double kTooFar = std::numeric_limits<double>::infinity();
constexpr double kThin = 1e-12;  // squared: width over length

// At right angles to edge k, in the plane of a triangle with the normal given.
Vec3 inward(const Corners& t, const Vec3& normal, std::uint32_t k) {
  return cross(normal, corner(t, (k + 1) % 3) - corner(t, k));
}

// A triangle, and where points are seen to be along its normal.
struct SeenAlongNormal {
  Corners corners;
  std::array<Vec3, 3> edge;
  Vec3 normal;
  double area;  // squared, of the parallelogram

  explicit SeenAlongNormal(const Corners& t)
      : corners(t),
        edge{t.b - t.a, t.c - t.b, t.a - t.c},
        normal(cross(edge[0], edge[1])),
        area(dot(normal, normal)) {}

  double squared_length(std::size_t k) const { return dot(edge[k], edge[k]); }

  // So thin that rounding may turn its normal anywhere.
  bool is_thin() const {
    const double longest = std::max({squared_length(0), squared_length(1), squared_length(2)});
    return !(area > kThin * longest * longest);
  }

  // How far p is inside of each edge, times the lengths of edge and normal.
  std::array<double, 3> depth(const Vec3& p) const {
    const Vec3 turned = cross(p - corners.a, normal);
    const double first = dot(edge[0], turned), last = dot(edge[2], turned);
    return {first, area - first - last, last};
  }
};

// The squared distance, or infinity where that is surely more than `limit`.
double squared_within(const SeenAlongNormal& seen, const Vec3& p, double limit) {
  const double height = dot(seen.normal, p - seen.corners.a), high = limit * seen.area;
  if (height * height > high) return kTooFar;
  const std::array<double, 3> depth = seen.depth(p);
  bool over = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (depth[k] >= 0) continue;
    if (depth[k] * depth[k] > high * seen.squared_length(k)) return kTooFar;
    over = false;
  }
  return over ? height * (height / seen.area) : squared_distance(seen.corners, p);
}

// Not numbers where the triangle has no area.
Vec3 unit_inward(const Corners& t, std::uint32_t k) {
  const Vec3 in = inward(t, normal_of(t), k);
  return in * (1 / length(in));
}

}  // namespace

WitnessSurface::WitnessSurface(const TriangleBvh& bvh)
    : bvh_(&bvh),
      own_across_(face_neighbours(bvh.faces(), bvh.positions().size())),
      across_(own_across_) {}

WitnessSurface::WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape)
    : bvh_(&bvh), across_(shape.across_) {}

double WitnessSurface::farthest_within(std::span<const Vec3> points, std::uint32_t t,
                                       double most) const {
  const SeenAlongNormal seen(triangle(t));
  const bool thin = seen.is_thin();
  const double limit = most * most;
  double farthest = 0;
  for (const Vec3& p : points) {
    const double squared =
        thin ? squared_distance(seen.corners, p) : squared_within(seen, p, limit);
    if (squared > limit) return kTooFar;
    farthest = std::max(farthest, squared);
  }
  return std::sqrt(farthest);
}

std::array<double, 3> WitnessSurface::overhang(const Vec3& p, std::uint32_t t) const {
  const Corners s = triangle(t);
  return {-dot(unit_inward(s, 0), p - s.a), -dot(unit_inward(s, 1), p - s.b),
          -dot(unit_inward(s, 2), p - s.c)};
}

WitnessSurface::Plane WitnessSurface::bisector(std::uint32_t t, std::uint32_t edge) const {
  const Corners s = triangle(t);
  const Vec3 normal =
      unit_inward(s, edge) - unit_inward(triangle(across(t, edge)), edge_across(t, edge));
  const double size = length(normal);
  return {corner(s, edge), size > 0 ? normal * (1 / size) : Vec3{}};
}

std::uint32_t WitnessSurface::stroll(const Vec3& p, std::uint32_t start) const {
  std::uint32_t at = start, before = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const SeenAlongNormal seen(triangle(at));
    const std::array<double, 3> depth = seen.depth(p);
    std::uint32_t next = at;
    double most = 0, of = 1;  // squared, as a fraction
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (!(depth[k] < 0)) continue;
      const double size = seen.squared_length(k);
      if (depth[k] * depth[k] * of <= most * size) continue;
      most = depth[k] * depth[k], of = size, next = across(at, k);
    }
    if (next == before || next == at) break;
    before = at, at = next;
  }
  return at;
}

std::uint32_t WitnessSurface::walk(const Vec3& p, std::uint32_t start) const {
  std::uint32_t best = start, before = start;
  double squared = squared_distance(triangle(start), p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::uint32_t from = best;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t t = across(from, k);
      if (t == before || t == from) continue;
      const double other = squared_distance(triangle(t), p);
      if (other < squared) squared = other, best = t;
    }
    if (best == from) break;
    before = from;
  }
  return best;
}

SurfacePoint WitnessSurface::closest(const Vec3& p, std::uint32_t hint) const {
  return bvh_->closest(p, {squared_distance(triangle(hint), p), hint});
}

}  // namespace vitrine
