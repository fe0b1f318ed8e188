// SPDX-License-Identifier: Apache-2.0
// Measures the distance between two surfaces, from samples of both [CRS98].
#pragma once

#include <cstddef>
#include <cstdint>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_bvh.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct MeasureOptions {
  std::size_t samples = 200'000;  // samples per surface, at least 1
  std::uint64_t seed = 1;
};

struct OneWayDistance {
  double rms = 0, p95 = 0, max = 0;  // distances in model units
};

struct SurfaceDistance {
  double rms = 0, max = 0;  // the larger value of both directions, in model units
  // rms and max as percentages of the diagonal of B's bounding box. 0 if the box is a point.
  double rms_percent = 0, max_percent = 0;
  OneWayDistance a_to_b, b_to_a;
};

// Fails (kBadInput) if a mesh has no face or a face index is out of range. `a` and `b` are called A
// and B in the message.
Expected<void> check_measurable(const TriangleMesh& a, const TriangleMesh& b);

// Samples each surface uniformly by area and finds the closest point on the other surface. Fails
// like check_measurable().
Expected<SurfaceDistance> measure(const TriangleMesh& a, const TriangleMesh& b,
                                  const MeasureOptions& options = {});

// Returns the larger rms distance of the two directions. Takes bounding volume hierarchies, so that
// a caller that measures one surface several times builds its hierarchy only once. Both surfaces
// must have at least one face.
double rms_distance(const TriangleBvh& a, const TriangleBvh& b, const MeasureOptions& options = {});

}  // namespace vitrine::inline codec
