// SPDX-License-Identifier: Apache-2.0
// A surface whose single triangles bear witness to distances.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine {

class WitnessSurface {
 public:
  // `bvh` outlives this.
  explicit WitnessSurface(const TriangleBvh& bvh);
  // `bvh` was made from that of `shape` for moved vertices; both outlive this.
  WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape);
  WitnessSurface(WitnessSurface&&) = default;

  std::size_t size() const { return across_.size(); }
  Corners triangle(std::uint32_t t) const { return bvh_->triangle(t); }
  const Vec3& point(std::uint32_t t, std::uint32_t k) const {
    return bvh_->point(t, k);
  }  // corner k
  // The triangle across edge k, from corner k to the next; t itself at a border.
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge] / 3; }
  // Which of that triangle's edges it is.
  std::uint32_t edge_across(std::uint32_t t, std::uint32_t edge) const {
    return across_[t][edge] % 3;
  }

  // The largest distance from one of the points to triangle t; infinity where it is more than
  // `most`, which is much cheaper to tell.
  double farthest_within(std::span<const Vec3> points, std::uint32_t t, double most) const;

  // How far p reaches beyond each edge of t, seen along its normal; negative inside.
  std::array<double, 3> overhang(const Vec3& p, std::uint32_t t) const;

  // The plane that halves the angle between t and its neighbour across an edge; the unit normal
  // points to the side of t. Zero where one of the two has no area.
  struct Plane {
    Vec3 point, normal;
  };
  Plane bisector(std::uint32_t t, std::uint32_t edge) const;

  // A triangle below or above p, found by crossing edges that p lies beyond. Several times cheaper
  // than walk(), but astray where the surface bends much.
  std::uint32_t stroll(const Vec3& p, std::uint32_t start) const;
  // A triangle near p that no neighbour beats, found by walking from `start`.
  std::uint32_t walk(const Vec3& p, std::uint32_t start) const;
  // The closest triangle of all; `hint` speeds the search up.
  SurfacePoint closest(const Vec3& p, std::uint32_t hint) const;

 private:
  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> own_across_;
  std::span<const std::array<std::uint32_t, 3>> across_;  // half-edges; own, or the shape's
};

}  // namespace vitrine
