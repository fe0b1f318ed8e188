// SPDX-License-Identifier: Apache-2.0
// A mesh of any size out of a small scan: each triangle is cut into n^2, and the new vertices are
// moved along the scan's normals by waves of several lengths, so that the detail is new, too.
#pragma once

#include <cstdint>
#include <ostream>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

// Writes at least `triangles` as a binary PLY. Holds what the scan needs, whatever the number: the
// triangles are written as they come. Vertices are numbered as the scan's faces meet them. The scan
// is a manifold (repair.h). Returns the number of triangles.
std::uint64_t write_subdivided(const TriangleMesh& scan, std::uint64_t triangles,
                               std::ostream& out);

}  // namespace vitrine::bench
