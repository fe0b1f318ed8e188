// SPDX-License-Identifier: Apache-2.0
// A surface whose single triangles bear witness to distances.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine {

class WitnessSurface {
 public:
  // `bvh` was built from `mesh` and outlives this.
  WitnessSurface(const TriangleBvh& bvh, const TriangleMesh& mesh);
  // `bvh` was made from that of `shape` for moved vertices, and outlives this.
  WitnessSurface(const TriangleBvh& bvh, const WitnessSurface& shape);

  std::size_t size() const { return across_.size(); }
  const Corners& triangle(std::uint32_t t) const { return bvh_->triangles()[t]; }
  // The triangle across edge k, from corner k to the next; t itself at a border.
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge] / 3; }
  // Which of that triangle's edges it is.
  std::uint32_t edge_across(std::uint32_t t, std::uint32_t edge) const {
    return across_[t][edge] % 3;
  }

  // An upper bound on the distance from p to triangle t, at most a hundredth above it.
  double distance(const Vec3& p, std::uint32_t t) const;
  // The same; infinity, much cheaper, for most points farther away than `most`.
  double distance_within(const Vec3& p, std::uint32_t t, double most) const;

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
  // Unit vectors; the first entry of `normal` is not a number where the triangle has no area.
  struct Frame {
    std::array<float, 3> normal;
    std::array<std::array<float, 3>, 3> inward;  // in the plane, at right angles to edge k
  };
  static Frame make_frame(const Corners& t);
  void make_frames();

  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> across_;  // half-edges
  std::vector<Frame> frames_;
};

}  // namespace vitrine
