// SPDX-License-Identifier: Apache-2.0
// A mesh in the form of glTF: each vertex has one pair of texture coordinates and one material.
#pragma once

#include "bench/codec/peers.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

// number of attributes: u, v and the index of the material
inline constexpr std::uint32_t kWedgeAttributes = 3;

// Splits the vertices of a mesh at the seams of its texture coordinates and materials.
MeshoptInput wedge_mesh(const TriangleMesh& mesh, const Texturing& texturing);

// Returns the material of a face's first vertex.
std::uint16_t material_of(const MeshoptInput& mesh, std::size_t face);

// A mesh, and the parts of its texturing that belong to faces.
struct FacedMesh {
  TriangleMesh mesh;
  std::vector<std::uint16_t> face_materials;
  std::vector<std::array<TextureCoordinates, 3>> coordinates;
};

}  // namespace vitrine::bench
