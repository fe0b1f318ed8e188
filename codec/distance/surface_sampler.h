// SPDX-License-Identifier: Apache-2.0
// Samples points of a mesh, uniformly by area. The points are the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

struct SurfaceSample {
  Vec3 point;
  std::uint32_t triangle;  // index of the triangle that contains the point
};

// Returns stratified samples: divides the area into `count` equal shares, in the order of the
// triangles, and draws sample i from share i. Returns no samples if the surface has no triangle. If
// the area is zero, all samples lie in the last triangle.
std::vector<SurfaceSample> sample_surface(const TriangleBvh& surface, std::size_t count,
                                          std::uint64_t seed);

}  // namespace vitrine::inline codec
