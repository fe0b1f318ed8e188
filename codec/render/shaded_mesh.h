// SPDX-License-Identifier: Apache-2.0
// A mesh and everything that rendering needs, except what depends on the view.
#pragma once

#include <vector>

#include "codec/mesh/triangle_mesh.h"
#include "codec/render/textures.h"

namespace vitrine::inline codec {

struct ShadedMesh {
  const TriangleMesh& mesh;
  std::vector<Vec3> normals;           // per vertex, not normalised (vertex_normals.h)
  const Textures* textures = nullptr;  // null if the mesh has no materials
};

}  // namespace vitrine::inline codec
