// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/witness_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/mesh/face_neighbours.h"

namespace vitrine::inline codec {
namespace {

constexpr int kMaxSteps = 64;  // maximum number of steps in a walk
// allowed relative error of distances in searches of slender surfaces
constexpr double kPrecision = 0.02;
constexpr double kTooFar = std::numeric_limits<double>::infinity();
// A triangle is thin if the squared ratio of its width to its length is at most kThin.
constexpr double kThin = 1e-12;

// Returns the direction perpendicular to edge k that points into the triangle. `normal` is the
// triangle's normal.
Vec3 inward(const TrianglePoints& t, const Vec3& normal, std::uint32_t k) {
  return cross(normal, corner(t, (k + 1) % 3) - corner(t, k));
}

// A triangle that measures points after projecting them onto the triangle's plane.
struct SeenAlongNormal {
  TrianglePoints corners;
  std::array<Vec3, 3> edge;
  Vec3 normal;
  double area;  // squared length of `normal`: 4 times the squared triangle area

  explicit SeenAlongNormal(const TrianglePoints& t)
      : corners(t),
        edge{t.b - t.a, t.c - t.b, t.a - t.c},
        normal(cross(edge[0], edge[1])),
        area(dot(normal, normal)) {}

  double squared_length(std::size_t k) const { return dot(edge[k], edge[k]); }

  // Whether the triangle is so thin that rounding makes the direction of its normal meaningless.
  bool is_thin() const {
    const double longest = std::max({squared_length(0), squared_length(1), squared_length(2)});
    return !(area > kThin * longest * longest);
  }

  // Returns, for each edge, the distance of p from the edge, positive on the inner side. The
  // distance is multiplied by the lengths of the edge and of the normal.
  std::array<double, 3> depth(const Vec3& p) const {
    const Vec3 turned = cross(p - corners.a, normal);
    const double first = dot(edge[0], turned), last = dot(edge[2], turned);
    return {first, area - first - last, last};
  }
};

// Returns the squared distance from p to the triangle, or infinity if that distance certainly
// exceeds `limit`.
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

// Returns the unit vector perpendicular to edge k that points into the triangle, or NaN if the
// triangle has no area.
Vec3 unit_inward(const TrianglePoints& t, std::uint32_t k) {
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
  const TrianglePoints s = triangle(t);
  return {-dot(unit_inward(s, 0), p - s.a), -dot(unit_inward(s, 1), p - s.b),
          -dot(unit_inward(s, 2), p - s.c)};
}

WitnessSurface::Plane WitnessSurface::bisector(std::uint32_t t, std::uint32_t edge) const {
  const TrianglePoints s = triangle(t);
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
    double most = 0, of = 1;  // most / of: the largest squared distance beyond an edge so far
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

ClosestTriangle WitnessSurface::closest(const Vec3& p, std::uint32_t hint) const {
  return bvh_->closest(p, {squared_distance(triangle(hint), p), hint},
                       bvh_->is_slender() ? kPrecision : 0);
}

}  // namespace vitrine::inline codec
