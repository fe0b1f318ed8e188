// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/triangulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace vitrine {
namespace {

using ::testing::ElementsAre;

// Returns twice the total area of the triangles in the plane z = 0. Expects that each area is
// positive.
double total_area(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles) {
  double total = 0;
  for (const auto& [a, b, c] : triangles) {
    const double area = cross(p[b] - p[a], p[c] - p[a]).z;
    EXPECT_GT(area, 0);
    total += area;
  }
  return total;
}

std::vector<Triangle> cut(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> polygon(positions.size());
  std::iota(polygon.begin(), polygon.end(), 0);
  std::vector<Triangle> triangles;
  triangulate(positions, polygon, triangles);
  return triangles;
}

TEST(Triangulate, AConvexPolygonBecomesAFan) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_THAT(cut(square), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Triangulate, AConcavePolygonIsCoveredOnceAndKeepsItsDirection) {
  const std::vector<Vec3> arrow{{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}};
  EXPECT_DOUBLE_EQ(total_area(arrow, cut(arrow)), 6);
  const std::vector<Vec3> comb{{0, 0, 0}, {7, 0, 0}, {7, 5, 0}, {6, 1, 0},
                               {4, 5, 0}, {3, 1, 0}, {1, 5, 0}};
  const auto triangles = cut(comb);
  EXPECT_EQ(triangles.size(), 5u);
  double shoelace = 0;
  for (std::size_t i = 0; i < comb.size(); ++i) {
    shoelace += cross(comb[i], comb[(i + 1) % comb.size()]).z;
  }
  EXPECT_NEAR(total_area(comb, triangles), shoelace, 1e-12);
}

TEST(Triangulate, APolygonOfOnePointOrOneLineStillGivesAllItsTriangles) {
  EXPECT_EQ(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size(), 3u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}}).size(), 2u);
}

// Triangulation accepts such positions. Readers report them later, when they know which faces use
// them.
TEST(Triangulate, APolygonWithAPositionThatIsNotFiniteStillGivesAllItsTriangles) {
  std::vector<Vec3> positions(300);
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = {i % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1, 1, 1};
  EXPECT_EQ(cut(positions).size(), 298u);
}

}  // namespace
}  // namespace vitrine
