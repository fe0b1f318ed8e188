// SPDX-License-Identifier: Apache-2.0
// Iterated closest points ([BM92], point to plane [CM92]): moves the points of one scan onto the
// surface of another.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/plane_step.h"
#include "acquisition/alignment/surface_points.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::acquisition {

// Returns about `count` vertices of the mesh with their normals, evenly chosen.
SurfacePoints some_vertices(const TriangleMesh& mesh, std::size_t count);

// A surface to which scans are registered. Leaves out the rim, where the closest point is not the
// corresponding one.
class FixedSurface {
 public:
  explicit FixedSurface(const TriangleMesh& mesh);

  // Returns a pair for each moved point that is closer than `reach` mm to the surface and whose
  // normal differs from that of the surface by less than 60 degrees.
  std::vector<Counterpart> counterparts(const SurfacePoints& points, const RigidMotion& motion,
                                        double reach) const;

  const TriangleBvh& bvh() const { return bvh_; }

 private:
  TriangleBvh bvh_;
  std::vector<bool> rim_;
};

// Returns the rms distance from the planes, in mm; 0 without pairs.
double rms_of(std::span<const Counterpart> pairs);

// Returns the motion that lays the points on the surface, starting at `motion`. Takes `steps` steps
// at each of the distances `reaches`, in mm. Stops early if fewer than 12 points overlap.
RigidMotion register_points(const SurfacePoints& points, const FixedSurface& surface,
                            RigidMotion motion, std::span<const double> reaches, int steps);

}  // namespace vitrine::acquisition
