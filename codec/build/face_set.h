// SPDX-License-Identifier: Apache-2.0
// The set of faces of a mesh, independent of the order of its vertices and faces.
#pragma once

#include <array>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// A corner of a face: its position and attributes. A FaceKey holds the three corners in the
// lexicographically smallest of their three rotations, which keeps the orientation. Faces without
// area may have equal corners, so whole rotations are compared.
struct FaceCorner {
  Vec3i position;
  VertexAttributes::Row attributes;
  auto operator<=>(const FaceCorner&) const = default;
};
using FaceKey = std::array<FaceCorner, 3>;

// Returns the faces in sorted order. Two meshes have equal results if and only if they have the
// same faces, orientations and attributes, regardless of how their vertices are split or ordered.
std::vector<FaceKey> face_set(const LatticeMesh& mesh);

}  // namespace vitrine::inline codec
