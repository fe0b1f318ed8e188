// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codec/distance/distance_map.h"
#include "codec/distance/rigid_alignment.h"
#include "codec/mesh/triangle_bvh.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

// Returns random triangles, including slivers, segments and points.
TriangleMesh random_soup(unsigned seed, std::uint32_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  TriangleMesh mesh;
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 a = point(), b = a + (point() - Vec3{0.5, 0.5, 0.5}) * 0.3;
    const Vec3 c = i % 7 == 0 ? a + (b - a) * 0.3 : a + (point() - Vec3{0.5, 0.5, 0.5}) * 0.3;
    mesh.positions.insert(mesh.positions.end(), {a, i % 11 == 0 ? a : b, i % 13 == 0 ? a : c});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Returns the distance from p to the closest point of a dense grid on the triangle.
double sampled_distance(const TrianglePoints& t, const Vec3& p) {
  constexpr int kGrid = 200;
  double best = 1e300;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; i + j <= kGrid; ++j) {
      const Vec3 q = t.a + (t.b - t.a) * (1.0 * i / kGrid) + (t.c - t.a) * (1.0 * j / kGrid);
      best = std::min(best, length(p - q));
    }
  }
  return best;
}

TriangleMesh square(double side, double height) {
  return {.positions = {{0, 0, height}, {side, 0, height}, {side, side, height}, {0, side, height}},
          .faces = {{0, 1, 2}, {0, 2, 3}},
          .attributes = {}};
}

TEST(ClosestPoint, IsAsCloseAsTheBestOfManyPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-0.5, 1.5);
  const TriangleBvh soup(random_soup(7, 40));
  for (std::uint32_t i = 0; i < soup.size(); ++i) {
    const TrianglePoints t = soup.triangle(i);
    const Vec3 p{unit(random), unit(random), unit(random)};
    const double exact = std::sqrt(squared_distance(t, p)), sampled = sampled_distance(t, p);
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 0.01);
  }
}

TEST(TriangleBvh, FindsTheSameDistanceAsATestOfEveryTriangle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 2);
  const TriangleMesh mesh = random_soup(3, 500);
  const TriangleBvh bvh(mesh);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p{unit(random), unit(random), unit(random)};
    double best = 1e300;
    for (std::uint32_t t = 0; t < bvh.size(); ++t)
      best = std::min(best, squared_distance(bvh.triangle(t), p));
    EXPECT_EQ(bvh.closest(p).squared, best);
    const std::uint32_t any = static_cast<std::uint32_t>(random() % mesh.faces.size());
    const ClosestTriangle bounded = bvh.closest(p, {squared_distance(bvh.triangle(any), p), any});
    EXPECT_EQ(bounded.squared, best);
    EXPECT_EQ(squared_distance(bvh.triangle(bounded.triangle), p), best);
  }
}

TEST(TriangleBvh, HoldsEveryFaceOnce) {
  const TriangleMesh mesh = random_soup(5, 333);
  const TriangleBvh bvh(mesh);
  std::vector<Triangle> held;
  for (const Triangle& f : bvh.faces())
    held.push_back({bvh.vertices()[f[0]], bvh.vertices()[f[1]], bvh.vertices()[f[2]]});
  EXPECT_TRUE(std::ranges::is_permutation(held, mesh.faces));
  for (std::uint32_t t = 0; t < bvh.size(); ++t)
    EXPECT_EQ(bvh.triangle(t).a, mesh.positions[held[t][0]]);
}

TEST(TriangleBvh, FindsTheSameDistanceAfterItsVerticesMoved) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 2);
  const TriangleBvh shape(random_soup(4, 300));
  std::vector<Vec3> places(shape.positions().begin(), shape.positions().end());
  for (Vec3& p : places)
    p += Vec3{unit(random), unit(random), unit(random)} * 0.1;
  const TriangleBvh moved(shape, places);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p{unit(random), unit(random), unit(random)};
    double best = 1e300;
    for (std::uint32_t t = 0; t < moved.size(); ++t)
      best = std::min(best, squared_distance(moved.triangle(t), p));
    EXPECT_EQ(moved.closest(p).squared, best);
  }
}

TEST(TriangleBvh, AnswersOnNothingWithTheBound) {
  const TriangleBvh bvh(TriangleMesh{});
  EXPECT_TRUE(bvh.empty());
  EXPECT_EQ(bvh.closest({0, 0, 0}, {4.0, 9}).triangle, 9u);
}

TEST(Measure, ParallelSquaresAreTheirGapApart) {
  const auto d = measure(square(3, 0), square(3, 0.5), {.samples = 1000});
  ASSERT_TRUE(d.has_value());
  EXPECT_NEAR(d->rms, 0.5, 1e-12);
  EXPECT_NEAR(d->max, 0.5, 1e-12);
  EXPECT_NEAR(d->a_to_b.p95, 0.5, 1e-12);
  EXPECT_NEAR(d->rms_percent, 100 * 0.5 / std::sqrt(18.0), 1e-6);
}

TEST(Measure, TellsTheTwoDirectionsApart) {
  const auto d = measure(square(1, 0), square(3, 0), {.samples = 20'000});
  ASSERT_TRUE(d.has_value());
  EXPECT_NEAR(d->a_to_b.max, 0, 1e-12);
  EXPECT_NEAR(d->b_to_a.max, std::sqrt(8.0), 0.05);
  EXPECT_EQ(d->max, d->b_to_a.max);
  EXPECT_LT(d->b_to_a.rms, d->b_to_a.p95);
  EXPECT_LT(d->b_to_a.p95, d->b_to_a.max);
}

TEST(Measure, GivesTheSameFiguresForTheSameSeed) {
  const TriangleMesh a = sheet(12, 9), b = square(11, 0.3);
  const auto once = measure(a, b, {.samples = 5000, .seed = 4});
  const auto again = measure(a, b, {.samples = 5000, .seed = 4});
  const auto other = measure(a, b, {.samples = 5000, .seed = 5});
  EXPECT_EQ(once->rms, again->rms);
  EXPECT_NE(once->rms, other->rms);
  EXPECT_NEAR(once->rms, other->rms, 0.02 * once->rms);
}

TEST(Measure, AlignmentUndoesARigidMotion) {
  const TriangleMesh still = shipped_model("demosthenes.obj");
  TriangleMesh moved = still;
  Vec3 low = still.positions[0], high = low;
  for (Vec3& p : moved.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    p = {0.995 * p.x - std::sqrt(1 - 0.995 * 0.995) * p.y,
         std::sqrt(1 - 0.995 * 0.995) * p.x + 0.995 * p.y, p.z};
  }
  for (Vec3& p : moved.positions)
    p += (high - low) * 0.02;
  EXPECT_GT(measure(moved, still, {.samples = 2000})->rms_percent, 1);
  EXPECT_LT(measure(*aligned(moved, still), still, {.samples = 2000})->rms_percent, 0.01);
}

TEST(Measure, DoesNotScaleWhenItAligns) {
  TriangleMesh large = torus(40, 20);
  for (Vec3& p : large.positions)
    p = p * 1.1;
  const TriangleMesh small = torus(40, 20);
  EXPECT_GT(measure(*aligned(large, small), small, {.samples = 2000})->rms, 0.2);
}

TEST(DistanceMap, IsRedOutsideBlueInsideAndGreyWhereBothAgree) {
  TriangleMesh a = square(2, 0);
  a.positions = {{0.5, 0.5, 0}, {1, 0.5, 0.1}, {1, 1, 0.2}, {0.5, 1, -0.4}};
  const TriangleMesh b = square(3, 0);
  const auto map = distance_map(a, b, 0.2);
  EXPECT_EQ(map->range, 0.2);
  EXPECT_EQ(map->mesh.positions, a.positions);
  const Colour grey{224, 224, 220}, red{190, 38, 34}, blue{33, 72, 184};
  EXPECT_EQ(map->mesh.attributes.colours, (std::vector<Colour>{grey, {207, 131, 127}, red, blue}));
}

// Returns a torus with every `nth` vertex moved far away.
TriangleMesh torus_with_outliers(std::size_t nth) {
  TriangleMesh mesh = torus(40, 20);
  for (std::size_t v = 0; v < mesh.positions.size(); v += nth)
    mesh.positions[v].y += 50;
  return mesh;
}

TEST(DistanceMap, HasTheRangeOfNearlyAllVertices) {
  TriangleMesh a = torus_with_outliers(50);
  for (Vec3& p : a.positions)
    p.y += 0.001;
  const TriangleMesh b = torus(40, 20);
  EXPECT_LT(distance_map(a, b)->range, 0.002);
  EXPECT_EQ(distance_map({}, b).error().message, measure({}, b).error().message);
}

TEST(DistanceMap, ShowsAChangeOfASmallPart) {
  const TriangleMesh a = torus_with_outliers(50), b = torus(40, 20);
  const auto map = distance_map(a, b);
  EXPECT_GT(map->range, 10);
  const Colour grey{224, 224, 220};
  for (std::size_t v = 0; v < a.positions.size(); ++v)
    EXPECT_EQ(map->mesh.attributes.colours[v] == grey, v % 50 != 0) << v;
}

TEST(DistanceMap, OfEqualSurfacesIsGrey) {
  const TriangleMesh a = torus(40, 20);
  const auto map = distance_map(a, a);
  for (const Colour& colour : map->mesh.attributes.colours)
    EXPECT_EQ(colour, (Colour{224, 224, 220}));
}

TEST(Measure, CopesWithFacesWithoutArea) {
  TriangleMesh mesh = square(2, 0);
  mesh.faces.push_back({0, 0, 1});
  mesh.faces.push_back({2, 2, 2});
  EXPECT_NEAR(measure(mesh, square(2, 0), {.samples = 500})->max, 0, 1e-12);
  const TriangleMesh point{.positions = {{0, 0, 3}}, .faces = {{0, 0, 0}}, .attributes = {}};
  EXPECT_NEAR(measure(point, square(2, 0), {.samples = 10})->a_to_b.max, 3, 1e-12);
}

TEST(Measure, RefusesAMeshWithoutSurface) {
  EXPECT_FALSE(measure(TriangleMesh{}, square(1, 0)).has_value());
  EXPECT_FALSE(measure(square(1, 0), TriangleMesh{}).has_value());
  TriangleMesh broken = square(1, 0);
  broken.faces.push_back({0, 1, 9});
  EXPECT_FALSE(measure(broken, square(1, 0)).has_value());
}

TEST(FitMotion, RecoversARotationOfHalfATurn) {
  const std::vector<Vec3> from = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 1, 1}};
  std::vector<Vec3> to;
  for (const Vec3& p : from)
    to.push_back(Vec3{-p.x, -p.y, p.z} + Vec3{5, 6, 7});
  const RigidMotion motion = fit_motion(from, to);
  for (std::size_t i = 0; i < from.size(); ++i) {
    EXPECT_LT(length(motion(from[i]) - to[i]), 1e-12);
  }
}

}  // namespace
}  // namespace vitrine::test
