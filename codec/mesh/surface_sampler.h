// SPDX-License-Identifier: Apache-2.0
// Points spread uniformly by area over a mesh, the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine {

struct SurfaceSample {
  Vec3 point;
  std::uint32_t triangle;  // of the surface
};

// Stratified: sample i lies in the i-th of `count` equal shares of the area, in the order of
// triangles. Empty where there is no triangle; on the first corners where there is no area.
std::vector<SurfaceSample> sample_surface(const TriangleBvh& surface, std::size_t count,
                                          std::uint64_t seed);

}  // namespace vitrine
