// SPDX-License-Identifier: Apache-2.0
// The set of faces of a mesh, independent of the order of its vertices and faces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/core/vec2.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/refine/refiner.h"

namespace vitrine::inline codec {

// The position and attributes of a face's corner. A FaceKey holds the three corners of a face,
// rotated to the lexicographically smallest order. Rotation keeps the orientation. All three
// rotations are compared, because a face without area may have equal corners.
struct FaceCorner {
  Vec3i position;
  VertexAttributes::Row attributes;
  auto operator<=>(const FaceCorner&) const = default;
};
using FaceKey = std::array<FaceCorner, 3>;

// Returns the faces of `mesh` in sorted order. Two meshes give equal results if and only if they
// have the same faces with the same orientations and attributes. The order of vertices and faces
// does not matter, nor whether faces share vertices.
std::vector<FaceKey> face_set(const LatticeMesh& mesh);

// A face's corner with its texture coordinates.
struct TexturedCorner {
  Vec3i position;
  Vec2i texture;
  auto operator<=>(const TexturedCorner&) const = default;
};
using TexturedFaceKey = std::array<TexturedCorner, 3>;

// Like face_set(), with texture coordinates instead of attributes. Returns an empty set if
// `refiner` has no texture coordinates.
std::vector<TexturedFaceKey> textured_face_set(const Refiner& refiner);

// A face's corner with the exact bits of its texture coordinates in the source, for all sets of
// coordinates.
struct SourceCorner {
  Vec3i position;
  std::array<std::uint32_t, 2 * kCoordinateSets> texture{};
  auto operator<=>(const SourceCorner&) const = default;
};
struct SourceFaceKey {
  std::array<SourceCorner, 3> corners;
  std::uint16_t material = 0;
  auto operator<=>(const SourceFaceKey&) const = default;
};

// Like face_set(), with material and texture coordinates instead of attributes. `texturing`
// describes the faces of `mesh`.
std::vector<SourceFaceKey> source_face_set(const LatticeMesh& mesh, const Texturing& texturing);

}  // namespace vitrine::inline codec
