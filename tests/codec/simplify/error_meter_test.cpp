// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/error_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "codec/mesh/surface_distance.h"
#include "codec/simplify/hausdorff_bound.h"
#include "codec/simplify/simplify.h"
#include "support/dense_distance.h"
#include "support/meshes.h"

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

void expect_tight(const LevelError& error, const TriangleMesh& level,
                  const TriangleMesh& original) {
  const double bound = error.max_error;
  const double there = dense_maximum(level, TriangleBvh(original));
  const double back = dense_maximum(original, TriangleBvh(level));
  EXPECT_GE(bound, std::max(there, back) * (1 - 1e-9));
  EXPECT_LE(bound, std::max(there, back) * 1.06);
}

void expect_tight(const TriangleMesh& level, const TriangleMesh& original) {
  expect_tight(ErrorMeter(original).measure(level), level, original);
}

TriangleMesh base_of(const TriangleMesh& mesh, std::uint32_t vertices) {
  const LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, 12));
  auto hierarchy = simplify(fine, {.target_vertices = vertices});
  EXPECT_TRUE(hierarchy.has_value());
  return to_model(hierarchy->base);
}

TEST(ErrorMeter, BoundIsTrueAndTightOnAScan) {
  const TriangleMesh scan = shipped_model("demosthenes.obj");
  for (std::uint32_t vertices : {300u, 1200u, 5000u}) {
    SCOPED_TRACE(vertices);
    expect_tight(base_of(scan, vertices), scan);
  }
}

TEST(ErrorMeter, BoundIsTrueAndTightAfterQuantisationAlone) {
  const TriangleMesh scan = shipped_model("demosthenes.obj");
  expect_tight(to_model(quantise(scan, fit_lattice(scan.positions, 10))), scan);
}

TEST(ErrorMeter, BoundIsTrueAndTightForMovedVerticesOfKnownOrigin) {
  const TriangleMesh scan = shipped_model("demosthenes.obj");
  for (int bits : {8, 12}) {
    const Lattice lattice = fit_lattice(scan.positions, bits);
    const auto round = [&](const Vec3& p) { return lattice.to_model(lattice.to_lattice(p)); };
    expect_tight(ErrorMeter(scan).measure_moved(round), to_model(quantise(scan, lattice)), scan);
  }
  // Along itself: vertices move much, the surface hardly.
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

// The faces with a corner in a region.
TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::uint16_t>& regions,
                     std::uint16_t which) {
  TriangleMesh part{.positions = mesh.positions, .faces = {}, .colours = {}};
  const auto is_in = [&](VertexId v) { return regions[v] == which; };
  std::ranges::copy_if(mesh.faces, std::back_inserter(part.faces),
                       [&](const Triangle& f) { return std::ranges::any_of(f, is_in); });
  return part;
}

std::vector<std::uint16_t> in_quadrants(const TriangleMesh& mesh) {
  std::vector<std::uint16_t> regions;
  for (const Vec3& p : mesh.positions)
    regions.push_back(static_cast<std::uint16_t>((p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0)));
  return regions;
}

TEST(ErrorMeter, EveryRegionHasABoundOfItsOwn) {
  const TriangleMesh scan = shipped_model("demosthenes.obj"), level = base_of(scan, 1200);
  const LevelRegions regions{in_quadrants(level), in_quadrants(scan), 4};
  const LevelError error = ErrorMeter(scan).measure(level, regions);
  ASSERT_EQ(error.region_errors.size(), 4u);
  EXPECT_EQ(error.max_error, *std::ranges::max_element(error.region_errors));
  for (std::uint16_t k = 0; k < 4; ++k) {
    const double there = dense_maximum(part_of(level, regions.of_level, k), TriangleBvh(scan));
    const double back = dense_maximum(part_of(scan, regions.of_original, k), TriangleBvh(level));
    EXPECT_GE(error.region_errors[k], std::max(there, back) * (1 - 1e-9)) << "region " << k;
    EXPECT_LE(error.region_errors[k], std::max({there, back, 0.25 * error.max_error}) * 1.25);
  }
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

TEST(ErrorMeter, RmsAgreesWithMeasure) {
  const TriangleMesh scan = shipped_model("demosthenes.obj"), base = base_of(scan, 600);
  const double rms = ErrorMeter(scan).measure(base).rms_error;
  EXPECT_NEAR(rms, measure(base, scan)->rms, 0.04 * rms);
}

TEST(ErrorMeter, CopesWithFacesWithoutArea) {
  TriangleMesh flat = sheet(10, 10);
  flat.faces.push_back({0, 0, 1});
  flat.faces.push_back({5, 5, 5});
  const double negligible = 1e-6 * diagonal(flat);
  EXPECT_LE(ErrorMeter(flat).measure(sheet(10, 10)).max_error, negligible);
  EXPECT_LE(ErrorMeter(sheet(10, 10)).measure(flat).max_error, negligible);
  const TriangleMesh point{.positions = {{3, 3, 9}}, .faces = {{0, 0, 0}}, .colours = {}};
  const double far = dense_maximum(sheet(10, 10), TriangleBvh(point));
  EXPECT_GE(ErrorMeter(sheet(10, 10)).measure(point).max_error, far * (1 - 1e-9));
}

// Sheets that lie on each other: nearly all faces have no area, and walks end among them.
TEST(ErrorMeter, FoldedOntoItselfIsMeasuredInBoundedWork) {
  TriangleMesh folded = sheet(20, 20);
  for (Vec3& p : folded.positions)
    p = {std::round(p.x / 6), std::round(p.y / 6), 0};
  TriangleMesh coarse = sheet(4, 4);
  for (Vec3& p : coarse.positions)
    p = {p.x, p.y, 0};
  EXPECT_LT(ErrorMeter(folded).measure(coarse).max_error, 1e-5);
}

// Faces that cross each other at random: no walk along neighbours leads to the closest one.
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

}  // namespace
}  // namespace vitrine::test
