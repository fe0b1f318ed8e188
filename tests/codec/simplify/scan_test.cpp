// SPDX-License-Identifier: Apache-2.0
// Simplifies a scan of a bust, and checks the geometric errors that the result states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "codec/distance/surface_distance.h"
#include "support/hierarchies.h"
#include "support/meshes.h"
#include "support/random_mesh.h"
#include "support/tight_bound.h"

namespace vitrine::test {
namespace {

TEST(Simplify, ReachesItsTargetInFewLevels) {
  const LatticeMesh scan = on_lattice(shipped_model("demosthenes.obj"));
  const auto hierarchy = simplify(scan, {});
  ASSERT_TRUE(hierarchy.has_value());
  EXPECT_GE(hierarchy->base.positions.size(), 300u);
  EXPECT_LE(hierarchy->base.positions.size(), 375u);
  EXPECT_LE(hierarchy->levels.size(), 8u);
  std::size_t vertices = hierarchy->base.positions.size();
  for (const CollapseLevel& level : hierarchy->levels)
    vertices += level.size();
  EXPECT_EQ(vertices, scan.positions.size());
  EXPECT_EQ(hierarchy->tree.leaves(), 1u);
}

TEST(Simplify, RegionsAreAsManyAsTheLevelHasVerticesFor) {
  const LatticeMesh scan = on_lattice(shipped_model("demosthenes.obj"));
  const auto hierarchy = simplify(scan, {.region_vertices = 1500});
  ASSERT_TRUE(hierarchy.has_value());
  const auto last = static_cast<std::uint32_t>(hierarchy->levels.size());
  EXPECT_EQ(hierarchy->tree.regions_at(last).size(), hierarchy->tree.leaves());
  EXPECT_EQ(hierarchy->tree.regions_at(1).size(), 1u);
  std::size_t vertices = hierarchy->base.positions.size();
  for (std::uint32_t level = 1; level <= last; ++level) {
    vertices += hierarchy->levels[level - 1].size();
    const std::size_t regions = hierarchy->tree.regions_at(level).size();
    EXPECT_LE(vertices, regions * 1500) << "level " << level;
    EXPECT_TRUE(regions == 1 || vertices >= regions * 300) << "level " << level;
  }
}

TEST(Simplify, CoarseLevelsStandOnACoarserLatticeThatIsFinerThanTheirError) {
  for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
    const auto hierarchy =
        simplify(on_lattice(shipped_model("demosthenes.obj")), {.placement = placement});
    ASSERT_TRUE(hierarchy.has_value());
    const auto& shift = hierarchy->shift;
    ASSERT_EQ(shift.size(), hierarchy->levels.size() + 1);
    EXPECT_EQ(shift.back(), 0u);
    EXPECT_TRUE(std::is_sorted(shift.rbegin(), shift.rend()));
    EXPECT_GE(shift.front(), 2u);
    EXPECT_LE(shift.front(), 7u);
  }
}

TEST(SmallComponents, TenThousandSpecksDoNotGrowTheBase) {
  LatticeMesh scan = on_lattice(shipped_model("demosthenes.obj"));
  const std::size_t without = scan.positions.size();
  add_specks(scan, 10'000, 1);
  for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
    const auto hierarchy = simplify(scan, {.placement = placement, .region_vertices = 1500});
    ASSERT_TRUE(hierarchy.has_value());
    EXPECT_GE(hierarchy->base.positions.size(), 150u);
    EXPECT_LE(hierarchy->base.positions.size(), 375u);
    std::size_t vertices = hierarchy->base.positions.size() + inserted_vertices(*hierarchy);
    for (const CollapseLevel& level : hierarchy->levels)
      vertices += level.size();
    EXPECT_EQ(vertices, scan.positions.size());
    EXPECT_GT(inserted_vertices(*hierarchy), (scan.positions.size() - without) / 2);
  }
}

TEST(ErrorMeter, BoundIsTrueAndTightOnAScan) {
  const TriangleMesh scan = shipped_model("demosthenes.obj");
  for (std::uint32_t vertices : {300u, 1200u, 5000u}) {
    SCOPED_TRACE(vertices);
    expect_tight(base_of(scan, vertices), scan);
  }
}

TEST(Simplify, FollowsTheSurfaceAsItWasBeforeRounding) {
  const TriangleMesh scan = shipped_model("demosthenes.obj");
  // With positions of 8 bits, edges are only a few lattice steps long.
  const LatticeMesh fine = quantise(scan, fit_lattice(scan.positions, 8));
  const auto half = static_cast<std::uint32_t>(fine.positions.size() / 2);
  const auto rms = [&](std::span<const Vec3> original) {
    const auto hierarchy = simplify(fine, {.target_vertices = half}, original);
    return measure(to_model(hierarchy.value().base), scan)->rms;
  };
  EXPECT_LT(rms(scan.positions), 0.95 * rms({}));
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
}

// Returns the faces that have a corner in region `which`.
TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::uint16_t>& regions,
                     std::uint16_t which) {
  TriangleMesh part{.positions = mesh.positions, .faces = {}, .attributes = {}};
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

TEST(ErrorMeter, RmsAgreesWithMeasure) {
  const TriangleMesh scan = shipped_model("demosthenes.obj"), base = base_of(scan, 600);
  const double rms = ErrorMeter(scan).measure(base).rms_error;
  EXPECT_NEAR(rms, measure(base, scan)->rms, 0.04 * rms);
}

}  // namespace
}  // namespace vitrine::test
