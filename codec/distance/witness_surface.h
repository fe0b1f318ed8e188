// SPDX-License-Identifier: Apache-2.0
// A surface whose triangles serve as witnesses: the distance to one triangle is an upper bound of
// the distance to the whole surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

class WitnessSurface {
 public:
  // `bvh` must outlive this object.
  explicit WitnessSurface(const TriangleBvh& bvh);
  // Makes the surface of `bvh`, which must be a copy of the hierarchy of `shape` with moved
  // vertices. Both arguments must outlive this object.
  WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape);
  WitnessSurface(WitnessSurface&&) = default;

  std::size_t size() const { return across_.size(); }
  TrianglePoints triangle(std::uint32_t t) const { return bvh_->triangle(t); }
  // Returns corner k of triangle t.
  const Vec3& point(std::uint32_t t, std::uint32_t k) const { return bvh_->point(t, k); }
  // Returns the triangle on the other side of an edge of t, or t itself if the edge is a border
  // edge. Edge k runs from corner k to the next corner.
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge] / 3; }
  // Returns the index that the edge has in the triangle on its other side.
  std::uint32_t edge_across(std::uint32_t t, std::uint32_t edge) const {
    return across_[t][edge] % 3;
  }

  // Returns the largest distance from one of the points to triangle t. If that distance exceeds
  // `most`, returns infinity, which takes much less time.
  double farthest_within(std::span<const Vec3> points, std::uint32_t t, double most) const;

  // Returns how far p lies beyond each edge of t, seen along the normal of t. Negative numbers mean
  // inside.
  std::array<double, 3> overhang(const Vec3& p, std::uint32_t t) const;

  // The plane that halves the angle between t and its neighbour across an edge. The unit normal
  // points to the side of t. The normal is zero if one of the two triangles has no area.
  struct Plane {
    Vec3 point, normal;
  };
  Plane bisector(std::uint32_t t, std::uint32_t edge) const;

  // Returns a triangle above or below p, found by crossing the edges beyond which p lies. Several
  // times faster than walk(), but unreliable on strongly curved surfaces.
  std::uint32_t stroll(const Vec3& p, std::uint32_t start) const;
  // Returns a triangle near p that is closer to p than its neighbours are. Walks from `start`.
  std::uint32_t walk(const Vec3& p, std::uint32_t start) const;
  // Returns the closest triangle of the whole surface. `hint` makes the search faster.
  ClosestTriangle closest(const Vec3& p, std::uint32_t hint) const;

 private:
  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> own_across_;
  // Per triangle and edge: the opposite half-edge (face_neighbours.h). Refers to own_across_ or to
  // that of the shape.
  std::span<const std::array<std::uint32_t, 3>> across_;
};

}  // namespace vitrine::inline codec
