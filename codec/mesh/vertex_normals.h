// SPDX-License-Identifier: Apache-2.0
// Smooth vertex normals: the mean of the normals of a vertex's faces, weighted by area.
#pragma once

#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Returns the normal of each vertex. Normals are not unit vectors and may be 0.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

// Like vertex_normals(), but returns unit vectors. The viewer shades meshes in the same way. A
// vertex whose normal would be 0 gets (0, 0, 1).
std::vector<Vec3> unit_normals(const TriangleMesh& mesh);

// Like vertex_normals(), but the normal of a vertex includes the faces of all other vertices at the
// same position. A mesh with repeated vertices, as in STL, then looks like one with shared
// vertices.
std::vector<Vec3> position_normals(const TriangleMesh& mesh);

}  // namespace vitrine::inline codec
