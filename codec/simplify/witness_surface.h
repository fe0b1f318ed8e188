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

  std::size_t size() const { return across_.size(); }
  const Corners& triangle(std::uint32_t t) const { return bvh_->triangles()[t]; }
  // The triangle across edge k, from corner k to the next; t itself at a border.
  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const { return across_[t][edge]; }

  // An upper bound on the distance from p to triangle t, at most a hundredth above it.
  double distance(const Vec3& p, std::uint32_t t) const;

  // How far p reaches beyond each edge of t, seen along its normal; negative inside.
  std::array<double, 3> overhang(const Vec3& p, std::uint32_t t) const;

  // The plane that halves the angle between t and its neighbour across an edge; the unit normal
  // points to the side of t. Zero where one of the two has no area.
  struct Plane {
    Vec3 point, normal;
  };
  Plane bisector(std::uint32_t t, std::uint32_t edge) const;

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

  const TriangleBvh* bvh_;
  std::vector<std::array<std::uint32_t, 3>> across_;
  std::vector<Frame> frames_;
};

}  // namespace vitrine
