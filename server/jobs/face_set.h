// SPDX-License-Identifier: Apache-2.0
// A surface without its numbering: what it looks like, and nothing of how it is stored.
#pragma once

#include <array>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

// A face's corners, positions with colours, from the smallest of its three rotations on: the
// orientation is kept. Faces without area have equal corners, so all rotations are compared whole.
struct FaceCorner {
  Vec3i position;
  Colour colour{};
  auto operator<=>(const FaceCorner&) const = default;
};
using FaceKey = std::array<FaceCorner, 3>;

// Sorted. Equal for two meshes exactly where they have the same faces, orientations and colours,
// however their vertices are split or ordered.
std::vector<FaceKey> face_set(const LatticeMesh& mesh);

}  // namespace vitrine
