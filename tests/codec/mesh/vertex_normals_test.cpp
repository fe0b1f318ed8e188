// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/vertex_normals.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

// Two faces at a right angle. Each face has its own copies of the vertices of the common edge.
const TriangleMesh kRoof{
    .positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, -1}},
    .faces = {{0, 1, 2}, {3, 4, 5}},
    .attributes = {}};

TEST(VertexNormals, VerticesOfTheSamePositionShareTheirFacesIfAsked) {
  const auto own = vertex_normals(kRoof), shared = position_normals(kRoof);
  EXPECT_EQ(own[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(own[4], (Vec3{1, 0, 0}));
  for (const std::size_t v : {0, 1, 3, 4})
    EXPECT_EQ(shared[v], (Vec3{1, 0, 1})) << v;
  EXPECT_EQ(shared[2], own[2]);
  EXPECT_EQ(shared[5], own[5]);
}

TEST(VertexNormals, UnitNormalsHaveLengthOneAndADefault) {
  TriangleMesh mesh = kRoof;
  mesh.positions.push_back({9, 9, 9});  // a vertex without faces
  const auto normals = unit_normals(mesh);
  for (const Vec3& normal : normals)
    EXPECT_DOUBLE_EQ(length(normal), 1);
  EXPECT_EQ(normals[4], (Vec3{1, 0, 0}));
  EXPECT_EQ(normals.back(), (Vec3{0, 0, 1}));
}

TEST(VertexNormals, WithoutRepeatedPositionsBothAreTheSame) {
  TriangleMesh mesh = kRoof;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v].x += 0.01 * static_cast<double>(v);
  EXPECT_EQ(vertex_normals(mesh), position_normals(mesh));
}

}  // namespace
}  // namespace vitrine
