// SPDX-License-Identifier: Apache-2.0
// Registration by iterated closest points ([BM92]; point to plane, [CM92]): moves the points of one
// scan onto the surface of another scan.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/plane_step.h"
#include "acquisition/alignment/surface_points.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::acquisition {

// Returns about `count` vertices of the mesh with their normals, taken at regular intervals.
SurfacePoints some_vertices(const TriangleMesh& mesh, std::size_t count);

// A surface to which scans are registered. The triangles at its rim are left out: a closest point
// on the rim is usually not the corresponding point.
class FixedSurface {
 public:
  explicit FixedSurface(const TriangleMesh& mesh);

  // Returns a pair for each moved point that is closer than `reach` mm to the surface and whose
  // normal differs from the surface's normal by less than 60 degrees.
  std::vector<Counterpart> counterparts(const SurfacePoints& points, const RigidMotion& motion,
                                        double reach) const;

  const TriangleBvh& bvh() const { return bvh_; }

 private:
  TriangleBvh bvh_;
  std::vector<bool> rim_;
};

// Returns the rms distance of the points from the tangent planes at their counterparts, in mm, or 0
// if `pairs` is empty.
double rms_of(std::span<const Counterpart> pairs);

// Returns the motion that moves the points onto the surface. Starts at `motion`. For each limit in
// `reaches`, takes `steps` steps that use only counterparts() closer than the limit, in mm. Stops
// early if fewer than 12 points have a counterpart.
RigidMotion register_points(const SurfacePoints& points, const FixedSurface& surface,
                            RigidMotion motion, std::span<const double> reaches, int steps);

}  // namespace vitrine::acquisition
