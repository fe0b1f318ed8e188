// SPDX-License-Identifier: Apache-2.0
// Smooth normals: the mean of the normals of the faces at a vertex, weighted by area.
#pragma once

#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Returns the normal of each vertex; its length has no meaning, and 0 is possible.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

// Like vertex_normals(), but vertices with the same position share all their faces. So a file that
// repeats its vertices, such as STL, looks like the same surface with shared vertices.
std::vector<Vec3> position_normals(const TriangleMesh& mesh);

}  // namespace vitrine::inline codec
