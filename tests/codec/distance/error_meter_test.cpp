// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/error_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "codec/distance/hausdorff_bound.h"
#include "codec/simplify/simplify.h"
#include "support/dense_distance.h"
#include "support/hierarchies.h"
#include "support/meshes.h"
#include "support/tight_bound.h"

namespace vitrine::test {
namespace {

double diagonal(const TriangleMesh& mesh) {
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low);
}

// Moves each vertex by 0.4 along the surface, so that the surface itself hardly moves.
TEST(ErrorMeter, BoundIsTrueAndTightForVerticesThatSlide) {
  const auto slide = [](const Vec3& p) { return p + Vec3{0.4, 0, 0}; };
  TriangleMesh slid = sheet(60, 50);
  std::ranges::transform(slid.positions, slid.positions.begin(), slide);
  expect_tight(ErrorMeter(sheet(60, 50)).measure_moved(slide), slid, sheet(60, 50));
}

TEST(ErrorMeter, BoundIsTrueAndTightWithBoundariesAndHandles) {
  expect_tight(base_of(sheet(60, 50), 100), sheet(60, 50));
  expect_tight(base_of(tube(60, 40), 60), tube(60, 40));
  expect_tight(base_of(torus(80, 40), 100), torus(80, 40));
}

TEST(ErrorMeter, FindsASpikeThatSamplesMiss) {
  TriangleMesh spiked = sheet(60, 50);
  spiked.positions[60 * 25 + 30].z += 40;
  const LevelError error = ErrorMeter(spiked).measure(sheet(60, 50));
  EXPECT_GT(error.max_error, 38);
  EXPECT_LT(error.rms_error, 5);
}

TEST(ErrorMeter, FindsAPartThatTheLevelLost) {
  TriangleMesh with_speck = sheet(30, 30);
  const auto n = static_cast<std::uint32_t>(with_speck.positions.size());
  with_speck.positions.insert(with_speck.positions.end(),
                              {{5, 5, 60}, {5.01, 5, 60}, {5, 5.01, 60}});
  with_speck.faces.push_back({n, n + 1, n + 2});
  EXPECT_NEAR(ErrorMeter(with_speck).measure(sheet(30, 30)).max_error, 60, 10);
}

TEST(ErrorMeter, SeesAHoleThatTheLevelClosedAndAFoldThatItLost) {
  TriangleMesh torn = sheet(30, 30);
  std::erase_if(torn.faces, [&](const Triangle& f) {
    const Vec3& p = torn.positions[f[0]];
    return std::abs(p.x - 15) < 3 && std::abs(p.y - 15) < 3;
  });
  expect_tight(sheet(30, 30), torn);
  TriangleMesh folded = sheet(30, 30);
  for (Vec3& p : folded.positions) {
    if (p.x > 12 && p.x < 16) p.x = 28 - p.x, p.z += 2;
  }
  expect_tight(sheet(30, 30), folded);
}

TEST(ErrorMeter, TheSameSurfaceHasNoError) {
  const TriangleMesh mesh = torus(20, 12);
  const LevelError error = ErrorMeter(mesh).measure(mesh);
  EXPECT_LE(error.max_error, 1e-6 * diagonal(mesh));
  EXPECT_LT(error.rms_error, 1e-12);
}

TEST(ErrorMeter, CopesWithFacesWithoutArea) {
  TriangleMesh flat = sheet(10, 10);
  flat.faces.push_back({0, 0, 1});
  flat.faces.push_back({5, 5, 5});
  const double negligible = 1e-6 * diagonal(flat);
  EXPECT_LE(ErrorMeter(flat).measure(sheet(10, 10)).max_error, negligible);
  EXPECT_LE(ErrorMeter(sheet(10, 10)).measure(flat).max_error, negligible);
  const TriangleMesh point{.positions = {{3, 3, 9}}, .faces = {{0, 0, 0}}, .attributes = {}};
  const double far = dense_maximum(sheet(10, 10), TriangleBvh(point));
  EXPECT_GE(ErrorMeter(sheet(10, 10)).measure(point).max_error, far * (1 - 1e-9));
}

// Measures sheets that coincide. Nearly all their faces have no area, and walks from neighbour to
// neighbour end at such faces.
TEST(ErrorMeter, FoldedOntoItselfIsMeasuredInBoundedWork) {
  TriangleMesh folded = sheet(20, 20);
  for (Vec3& p : folded.positions)
    p = {std::round(p.x / 6), std::round(p.y / 6), 0};
  TriangleMesh coarse = sheet(4, 4);
  for (Vec3& p : coarse.positions)
    p = {p.x, p.y, 0};
  EXPECT_LT(ErrorMeter(folded).measure(coarse).max_error, 1e-5);
}

// Measures faces that cross each other at random. No walk from neighbour to neighbour leads to the
// closest face.
TEST(ErrorMeter, ATangleIsMeasuredInBoundedWork) {
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) * 0x1p-32; };
  TriangleMesh tangle;
  for (std::uint32_t f = 0; f < 600; ++f) {
    for (int k = 0; k < 3; ++k)
      tangle.positions.push_back({unit(), unit(), unit()});
    tangle.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  TriangleMesh moved = tangle;
  for (Vec3& p : moved.positions)
    p.x += 1e-3 * unit();
  const LevelError error = ErrorMeter(tangle).measure(moved);
  EXPECT_GE(error.max_error, dense_maximum(moved, TriangleBvh(tangle)) * (1 - 1e-9));
  EXPECT_LT(error.max_error, 0.05);
}

// Measures long triangles around one vertex. At any point, the bounding boxes of a quarter of them
// overlap, so each search takes long.
TEST(ErrorMeter, AFanOfManyFacesAtOneVertexIsMeasuredInBoundedWork) {
  const auto fan = [](std::uint32_t n, double height) {
    TriangleMesh mesh{{{0, 0, height}}, {}, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n;
      mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.01 * std::sin(5 * angle)});
      mesh.faces.push_back({0, i + 1, (i + 1) % n + 1});
    }
    return mesh;
  };
  const double error = ErrorMeter(fan(20'000, 0.3)).measure(fan(9'000, 0.31)).max_error;
  EXPECT_GE(error, 0.0095);
  EXPECT_LT(error, 0.02);
}

}  // namespace
}  // namespace vitrine::test
