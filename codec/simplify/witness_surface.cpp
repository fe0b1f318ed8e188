// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/witness_surface.h"

#include <cmath>
#include <limits>

#include "codec/mesh/face_neighbours.h"

namespace vitrine {
namespace {

constexpr int kMaxSteps = 64;  // of a walk

// At right angles to edge k, in the plane of a triangle with the normal given.
Vec3 inward(const Corners& t, const Vec3& normal, std::uint32_t k) {
  return cross(normal, corner(t, (k + 1) % 3) - corner(t, k));
}

Vec3 normal_of(const Corners& t) {
  return cross(t.b - t.a, t.c - t.a);
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

double WitnessSurface::distance_within(const Vec3& p, std::uint32_t t, double most) const {
  const Corners s = triangle(t);
  const Vec3 normal = normal_of(s);
  const double height = dot(normal, p - s.a);
  const bool far = height * height > most * most * dot(normal, normal);
  return far ? std::numeric_limits<double>::infinity() : std::sqrt(squared_distance(s, p));
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
    const Corners s = triangle(at);
    const Vec3 normal = normal_of(s);
    std::uint32_t next = at;
    double most = 0;  // squared
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vec3 in = inward(s, normal, k);
      const double beyond = -dot(in, p - corner(s, k)), size = dot(in, in);
      if (!(beyond > 0) || beyond * beyond <= most * size) continue;
      most = beyond * beyond / size, next = across(at, k);
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
