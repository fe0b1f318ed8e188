// SPDX-License-Identifier: Apache-2.0
// Makes a mesh of any size from a small scan: cuts each triangle into n² triangles. To add detail,
// waves of several lengths move the new vertices along the scan's normals.
#pragma once

#include <cstdint>
#include <ostream>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

// Writes at least `triangles` triangles as a binary PLY and returns their number. Triangles are
// written one by one, so the memory depends only on the scan. Vertices are numbered in the order in
// which the scan's faces use them. The scan must be a manifold (repair.h).
std::uint64_t write_subdivided(const TriangleMesh& scan, std::uint64_t triangles,
                               std::ostream& out);

}  // namespace vitrine::bench
