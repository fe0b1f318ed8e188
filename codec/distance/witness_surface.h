// SPDX-License-Identifier: Apache-2.0
// A surface whose triangles serve as witnesses. The distance from a point to a witness triangle is
// an upper bound of the point's distance to the whole surface.
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
  // Creates the surface of `bvh`, which must be a copy of the hierarchy of `shape` in which only
  // vertices were moved. Both arguments must outlive this object.
  WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape);
  WitnessSurface(WitnessSurface&&) = default;

  std::size_t size() const { return across_.size(); }
  TrianglePoints triangle(std::uint32_t t) const { return bvh_->triangle(t); }
  // Whether the surface has many long triangles side by side (triangle_bvh.h).
  bool is_slender() const { return bvh_->is_slender(); }
  // Returns corner k of triangle t.
  const Vec3& point(std::uint32_t t, std::uint32_t k) const { return bvh_->point(t, k); }
  // Returns the triangle across an edge of t, or t itself if the edge is a border edge. Edge k runs
  // from corner k to the next corner.
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge] / 3; }
  // Returns the index, 0 to 2, that an edge of t has in the triangle across this edge.
  std::uint32_t edge_across(std::uint32_t t, std::uint32_t edge) const {
    return across_[t][edge] % 3;
  }

  // Returns the largest distance from any of `points` to triangle t. Returns infinity if that
  // distance exceeds `most`, which saves much time.
  double farthest_within(std::span<const Vec3> points, std::uint32_t t, double most) const;

  // Returns, for each edge of t, how far p lies beyond the edge, as seen along the normal of t.
  // Negative numbers mean that p is inside.
  std::array<double, 3> overhang(const Vec3& p, std::uint32_t t) const;

  // The plane that bisects the angle between t and its neighbour across an edge. Its unit normal
  // points to the side of t. The normal is zero if one of the two triangles has no area.
  struct Plane {
    Vec3 point, normal;
  };
  Plane bisector(std::uint32_t t, std::uint32_t edge) const;

  // Returns a triangle above or below p. Starts at `start` and repeatedly crosses an edge beyond
  // which p lies. Several times faster than walk(), but unreliable on strongly curved surfaces.
  std::uint32_t stroll(const Vec3& p, std::uint32_t start) const;
  // Walks from `start` to a triangle that is closer to p than its neighbours are, and returns it.
  std::uint32_t walk(const Vec3& p, std::uint32_t start) const;
  // Returns the triangle of the whole surface that is closest to p. A triangle `hint` near p makes
  // the search faster. If the surface is slender (triangle_bvh.h), the result may be up to 1.02
  // times as far away as the closest triangle. This saves the comparison of all triangles around
  // one vertex or edge, which are equally close to points beyond it.
  ClosestTriangle closest(const Vec3& p, std::uint32_t hint) const;

 private:
  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> own_across_;
  // Per triangle and edge: the opposite half-edge (face_neighbours.h). Refers to own_across_, or to
  // the data of `shape`.
  std::span<const std::array<std::uint32_t, 3>> across_;
};

}  // namespace vitrine::inline codec
