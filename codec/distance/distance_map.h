// SPDX-License-Identifier: Apache-2.0
// Paints the distance between two surfaces on one of them, for example to show what has changed
// between two scans of an object.
#pragma once

#include <cstdint>
#include <optional>

#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Returns A, moved by a rotation and a translation so that it fits B best. `seed` chooses the
// samples of A. Fails (kBadInput) like measure().
Expected<TriangleMesh> aligned(const TriangleMesh& a, const TriangleMesh& b,
                               std::uint64_t seed = 1);

struct DistanceMap {
  TriangleMesh mesh;  // A, with a colour for each vertex
  double range = 0;   // distance, in model units, from which red and blue are strongest
};

// Colours each vertex of A by its distance to the closest point of B: from grey at 0 to the
// strongest colour at `range` and more. Vertices in front of B's closest face become red, vertices
// behind it blue. If `range` is not given, uses the distance that 95 % of the vertices do not
// exceed, or the largest distance if over 95 % of the vertices lie on B. Fails (kBadInput) like
// measure().
Expected<DistanceMap> distance_map(TriangleMesh a, const TriangleMesh& b,
                                   std::optional<double> range = {});

}  // namespace vitrine::inline codec
