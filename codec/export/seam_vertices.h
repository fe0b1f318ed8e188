// SPDX-License-Identifier: Apache-2.0
// Splits the vertices of a mesh at seams, for formats in which a vertex has only one pair of
// texture coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct SeamVertices {
  std::vector<Triangle> faces;          // indices of the new vertices
  std::vector<std::uint32_t> original;  // per new vertex: its vertex in the mesh
  // Per set of coordinates: one pair per new vertex. Empty if the texturing does not have the set.
  std::array<std::vector<TextureCoordinates>, kCoordinateSets> coordinates;
};

// Returns a mesh in which each vertex is split into one vertex for each of its different texture
// coordinates. Coordinates differ if any bit of any set differs. New vertices are in the order in
// which the faces first use them.
SeamVertices split_at_seams(const TriangleMesh& mesh, const Texturing& texturing);

}  // namespace vitrine::inline codec
