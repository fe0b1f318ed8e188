// SPDX-License-Identifier: Apache-2.0
// How far two surfaces are apart, by sampling.
#pragma once

#include <cstddef>
#include <cstdint>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_bvh.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct MeasureOptions {
  std::size_t samples = 200'000;  // per side, at least 1
  std::uint64_t seed = 1;
  bool align = false;  // move A onto B first: rigid, from where it is, no scale
};

struct OneWayDistance {
  double rms = 0, p95 = 0, max = 0;  // model units
};

struct SurfaceDistance {
  double rms = 0, max = 0;  // the larger of the two directions, model units
  double rms_percent = 0,
         max_percent = 0;  // of the diagonal of B's bounding box; 0 if it is a point
  OneWayDistance a_to_b, b_to_a;
};

// Samples each surface uniformly by area and looks for the closest point on the other. Fails
// (kBadInput) where a mesh has no face or a face index is out of range.
Expected<SurfaceDistance> measure(const TriangleMesh& a, const TriangleMesh& b,
                                  const MeasureOptions& options = {});

// The rms alone, for surfaces that are measured more than once; both have a face.
double rms_distance(const TriangleBvh& a, const TriangleBvh& b, const MeasureOptions& options = {});

}  // namespace vitrine
