// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/face_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vitrine {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr TextureCoordinates kA{1, 2}, kB{3, 4}, kC{5, 6}, kD{7, 8}, kNone{0, 0};
using CornerCoordinates = std::array<TextureCoordinates, 3>;

// The corners of a square, and a point inside it that gives a polygon a dent.
const std::vector<Vec3> kPositions{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {3, 2, 0}};

TEST(FaceList, PolygonsFollowTheTrianglesWithTheirMaterials) {
  FaceList faces;
  faces.use_material(2);
  faces.add(std::array{0u, 1u, 2u, 3u}, {});
  faces.add(Triangle{0, 1, 2});
  faces.use_material(5);
  faces.add(Triangle{1, 2, 3});
  faces.use_material(0);
  faces.use_material(7);
  faces.add(std::array{3u, 2u, 1u, 0u}, {});
  faces.cut_polygons(kPositions);
  EXPECT_EQ(faces.triangles.size(), 6u);
  EXPECT_THAT(faces.take_materials(), ElementsAre(2, 5, 2, 2, 7, 7));
  EXPECT_THAT(faces.coordinates, IsEmpty());
}

TEST(FaceList, FacesBeforeTheFirstMaterialHaveMaterial0) {
  FaceList faces;
  faces.add(Triangle{0, 1, 2});
  faces.add(std::array{0u, 1u, 2u, 3u}, {});
  faces.use_material(3);
  faces.add(Triangle{0, 1, 2});
  faces.cut_polygons(kPositions);
  EXPECT_THAT(faces.take_materials(), ElementsAre(0, 3, 0, 0));
}

TEST(FaceList, CoordinatesFollowTheCornersOfAFan) {
  FaceList faces;
  faces.add(std::array{0u, 1u, 2u, 3u}, std::array{kA, kB, kC, kD});
  faces.cut_polygons(kPositions);
  EXPECT_THAT(faces.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(faces.coordinates,
              ElementsAre(CornerCoordinates{kA, kB, kC}, CornerCoordinates{kA, kC, kD}));
}

// The polygon is concave, so it is cut by ear clipping. Vertex 0 occurs twice, with different
// texture coordinates.
TEST(FaceList, CoordinatesFollowTheCornersOfClippedEarsEvenIfAVertexRepeats) {
  const std::vector<Vec3> positions{{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}, {1, 3, 0}};
  const std::vector<std::uint32_t> polygon{0, 1, 2, 3, 0, 4};
  std::vector<TextureCoordinates> at_corners;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    at_corners.push_back({static_cast<float>(polygon[i]), static_cast<float>(i)});
  FaceList faces;
  faces.add(polygon, at_corners);
  faces.cut_polygons(positions);
  ASSERT_EQ(faces.triangles.size(), 4u);
  ASSERT_EQ(faces.coordinates.size(), 4u);
  std::vector<bool> seen(polygon.size(), false);
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(faces.coordinates[f][k][0], static_cast<float>(faces.triangles[f][k]));
      seen[static_cast<std::size_t>(faces.coordinates[f][k][1])] = true;
    }
  }
  EXPECT_THAT(seen, ::testing::Each(true));
}

TEST(FaceList, FacesWithoutCoordinatesGetZeros) {
  FaceList faces;
  faces.add(Triangle{0, 1, 2});
  faces.add(std::array{0u, 1u, 2u, 3u}, {});
  faces.add(std::array{0u, 1u, 2u}, std::array{kA, kB, kC});
  faces.add(Triangle{0, 1, 2});
  faces.add(std::array{0u, 1u, 2u, 3u}, std::array{kA, kB, kC, kD});
  faces.add(std::array{0u, 1u, 2u, 3u}, {});
  faces.cut_polygons(kPositions);
  const CornerCoordinates none{kNone, kNone, kNone};
  EXPECT_THAT(faces.coordinates, ElementsAre(none, CornerCoordinates{kA, kB, kC}, none, none, none,
                                             CornerCoordinates{kA, kB, kC},
                                             CornerCoordinates{kA, kC, kD}, none, none));
}

TEST(FaceList, DroppedTexturingLeavesTheFaces) {
  FaceList faces;
  faces.use_material(3);
  faces.add(std::array{0u, 1u, 2u, 3u}, std::array{kA, kB, kC, kD});
  faces.drop_texturing();
  faces.cut_polygons(kPositions);
  EXPECT_EQ(faces.triangles.size(), 2u);
  EXPECT_THAT(faces.coordinates, IsEmpty());
  EXPECT_THAT(faces.take_materials(), ElementsAre(0, 0));
}

}  // namespace
}  // namespace vitrine
