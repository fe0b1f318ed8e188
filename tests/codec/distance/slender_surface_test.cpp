// SPDX-License-Identifier: Apache-2.0
// Tests surfaces with many triangles around one vertex or edge. Counts how many nodes each search
// visits, and how often triangles are cut to bound the error.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "codec/distance/error_meter.h"
#include "codec/distance/witness_surface.h"
#include "codec/repair/triangulate.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

// Returns point `i` of `count` points on a wavy circle around the origin.
Vec3 rim_point(std::uint32_t i, std::uint32_t count) {
  const double angle = 2 * std::numbers::pi * i / count;
  return {std::cos(angle), std::sin(angle), 0.1 * std::sin(5 * angle)};
}

// Returns `count` triangles around one vertex.
TriangleMesh fan(std::uint32_t count) {
  TriangleMesh mesh{.positions = {{}}, .faces = {}, .attributes = {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.push_back(rim_point(i, count));
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % count});
  }
  return mesh;
}

// Returns `count` triangles at one edge, like the pages of a book. Each triangle has its own copy
// of the edge's vertices, as after a repair.
TriangleMesh pages(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 tip = rim_point(i, count);
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {0, 0, 1}, {tip.x, tip.y, 0.5}});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Returns a polygon with `count` corners, cut into triangles.
TriangleMesh polygon(std::uint32_t count) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.push_back(rim_point(i, count));
    corners.push_back(i);
  }
  triangulate(mesh.positions, corners, mesh.faces);
  return mesh;
}

std::vector<Vec3> points_near(const TriangleMesh& mesh, std::size_t count) {
  std::mt19937 random(1);
  const auto at = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < count; ++k) {
    const Triangle& f = mesh.faces[random() % mesh.faces.size()];
    const double u = at(0, 0.5), v = at(0, 0.5);
    const Vec3 a = mesh.positions[f[0]], b = mesh.positions[f[1]], c = mesh.positions[f[2]];
    const Vec3 moved{at(-1e-4, 1e-4), at(-1e-4, 1e-4), at(-1e-4, 1e-4)};
    points.push_back(a + (b - a) * u + (c - a) * v + moved);
  }
  return points;
}

double least_squared_distance(const TriangleBvh& bvh, const Vec3& p) {
  double least = INFINITY;
  for (std::uint32_t t = 0; t < bvh.size(); ++t)
    least = std::min(least, squared_distance(bvh.triangle(t), p));
  return least;
}

std::uint64_t nodes_visited(const TriangleMesh& mesh) {
  constexpr std::size_t kPoints = 1'000;
  const TriangleBvh bvh(mesh);
  const WitnessSurface surface(bvh);
  std::uint64_t visited = 0;
  for (const Vec3& p : points_near(mesh, kPoints))
    visited += surface.closest(p, 0).visited;
  return visited / kPoints;
}

TEST(SlenderSurface, ASearchVisitsHardlyMoreNodesInALargerFan) {
  for (const auto make : {fan, pages}) {
    const std::uint64_t few = nodes_visited(make(4'000)), many = nodes_visited(make(64'000));
    EXPECT_LE(many, 5 * few);  // would be 16 * few with axis-aligned boxes alone
    EXPECT_LE(many, 600u);
  }
}

TEST(SlenderSurface, OnlyOverlappingTrianglesNeedOrientedBoxes) {
  EXPECT_TRUE(TriangleBvh(fan(4'000)).is_slender());
  EXPECT_TRUE(TriangleBvh(pages(4'000)).is_slender());
  EXPECT_FALSE(TriangleBvh(fan(100)).is_slender());
  for (const TriangleMesh& mesh : {sheet(100, 100), tube(200, 50), torus(100, 50)})
    EXPECT_FALSE(TriangleBvh(mesh).is_slender());
}

TEST(SlenderSurface, AnExactQueryFindsTheClosestTriangle) {
  for (const TriangleMesh& mesh : {fan(4'000), pages(4'000)}) {
    const TriangleBvh bvh(mesh);
    ASSERT_TRUE(bvh.is_slender());
    for (const Vec3& p : points_near(mesh, 200)) {
      const ClosestTriangle found = bvh.closest(p);
      EXPECT_EQ(found.squared, least_squared_distance(bvh, p));
      EXPECT_EQ(found.squared, squared_distance(bvh.triangle(found.triangle), p));
      EXPECT_EQ(found.at_least, found.squared);
    }
  }
}

// The closest point of every page is on the edge that all pages share.
TEST(SlenderSurface, AnImpreciseQueryStatesHowCloseTrianglesMayBe) {
  TriangleMesh half = pages(6'000);
  half.faces.resize(3'000);
  const TriangleBvh bvh(half);
  bool is_any_imprecise = false;
  for (const Vec3& p : points_near(pages(6'000), 200)) {
    const ClosestTriangle found = bvh.closest(p, {}, 0.1);
    const double least = least_squared_distance(bvh, p);
    EXPECT_GE(found.squared, least);
    EXPECT_LE(found.squared, least * 1.1 * 1.1 * (1 + 1e-12));
    EXPECT_LE(found.at_least, least);
    EXPECT_GE(found.at_least * 1.1 * 1.1 * (1 + 1e-12), found.squared);
    is_any_imprecise |= found.at_least < found.squared;
  }
  EXPECT_TRUE(is_any_imprecise);
}

TEST(SlenderSurface, BoxesBoundTrianglesThatMoved) {
  const TriangleMesh mesh = fan(4'000);
  const TriangleBvh shape(mesh);
  ASSERT_TRUE(shape.is_slender());
  std::vector<Vec3> moved(shape.positions().begin(), shape.positions().end());
  for (Vec3& p : moved)
    p += {0.01, -0.02, 0.015};
  const TriangleBvh bvh(shape, moved);
  for (const Vec3& p : points_near(mesh, 200))
    EXPECT_EQ(bvh.closest(p).squared, least_squared_distance(bvh, p));
}

TEST(SlenderSurface, TheErrorOfAFanIsFound) {
  const double sagitta = 1 - std::cos(std::numbers::pi / 1'000);
  const LevelError error = ErrorMeter(fan(4'000)).measure(fan(1'000));
  EXPECT_GE(error.max_error, sagitta * 0.9);
  EXPECT_LE(error.max_error, 0.01);
  const LevelError lost = ErrorMeter(pages(4'000)).measure([] {
    TriangleMesh half = pages(4'000);
    half.faces.resize(2'000);
    return half;
  }());
  EXPECT_GE(lost.max_error, 0.999);  // the tip of a lost page is 1 away from the edge
  EXPECT_LE(lost.max_error, 1.05);
}

// Measures the levels of a model, each with half as many triangles as the previous one. Returns how
// often triangles were cut in total.
std::uint64_t cuts_for_levels(TriangleMesh (*make)(std::uint32_t), std::uint32_t count) {
  const ErrorMeter meter(make(count));
  std::uint64_t cuts = 0;
  for (std::uint32_t triangles = count / 2; triangles >= 150; triangles /= 2)
    cuts += meter.measure(make(triangles)).cuts;
  return cuts;
}

TEST(SlenderSurface, TheErrorsOfALargeFanTakeNLogNCuts) {
  for (const std::uint32_t count : {10'000, 20'000, 40'000, 80'000}) {
    for (const auto make : {fan, pages, polygon}) {
      const double most = count * std::log2(count);
      EXPECT_LE(static_cast<double>(cuts_for_levels(make, count)), most) << count;
    }
  }
}

// The fan with 100 rim points cuts off arcs of the rim. Its bound must be at least the distance
// between chord and arc, and at most 2 % more.
TEST(SlenderSurface, TheBoundOfAFanIsTrueAndTight) {
  TriangleMesh flat = fan(20'000), level = fan(100);
  for (TriangleMesh* mesh : {&flat, &level}) {
    for (Vec3& p : mesh->positions)
      p.z = 0;
  }
  const double sagitta = 1 - std::cos(std::numbers::pi / 100);
  const double error = ErrorMeter(flat).measure(level).max_error;
  EXPECT_GE(error, sagitta * (1 - 1e-9));
  EXPECT_LE(error, sagitta * 1.02);
}

}  // namespace
}  // namespace vitrine::test
