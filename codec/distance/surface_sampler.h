// SPDX-License-Identifier: Apache-2.0
// Samples points of a mesh uniformly by area. Gives the same points on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

struct SurfaceSample {
  Vec3 point;
  std::uint32_t triangle;  // triangle of the surface that contains the point
};

// Returns stratified samples. Sample i lies in the i-th of `count` equal shares of the area, in the
// order of triangles. Returns no samples if the surface has no triangle, and only points of the
// last triangle if the area of the surface is zero.
std::vector<SurfaceSample> sample_surface(const TriangleBvh& surface, std::size_t count,
                                          std::uint64_t seed);

}  // namespace vitrine::inline codec
