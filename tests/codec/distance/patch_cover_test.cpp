// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/patch_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "support/dense_distance.h"
#include "support/meshes.h"
#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

const TrianglePoints kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

// Returns a triangle in the plane z = 0.1 + slope * x, bounded by x >= -reach, y >= -reach and x +
// y <= 2 * reach.
TriangleMesh slope(double reach, double slope) {
  const auto at = [&](double x, double y) { return Vec3{x, y, 0.1 + slope * x}; };
  return {.positions = {at(-reach, -reach), at(3 * reach, -reach), at(-reach, 3 * reach)},
          .faces = {{0, 1, 2}}};
}

PatchCover::CoverResult cover(const TriangleMesh& mesh, double limit) {
  const TriangleBvh bvh(mesh);
  const WitnessSurface surface(bvh);
  const std::uint32_t start = surface.stroll({1.0 / 3, 1.0 / 3, 0}, 0);
  return PatchCover(surface).cover(kTriangle, 0, start, limit, 1);
}

// Returns a strip for each pair of successive points (x, z) of a profile. The strips run from y =
// -50 to y = 50.
TriangleMesh drawn_along_y(const std::vector<std::array<double, 2>>& profile) {
  TriangleMesh mesh;
  for (const auto& [x, z] : profile) {
    mesh.positions.push_back({x, -50, z});
    mesh.positions.push_back({x, 50, z});
  }
  for (std::uint32_t v = 0; v + 2 < mesh.positions.size(); v += 2) {
    mesh.faces.push_back({v, v + 2, v + 3});
    mesh.faces.push_back({v, v + 3, v + 1});
  }
  return mesh;
}

TEST(PatchCover, CountsTheHeightOverTheTriangleOnly) {
  // Outside the triangle to cover, the sloped plane is up to 75 high. This height must not count.
  const PatchCover::CoverResult result = cover(slope(50, 0.5), 0.7);
  EXPECT_TRUE(result.is_covered);
  EXPECT_GE(result.height, 0.6);
  EXPECT_NEAR(result.height, 0.6, 1e-3);
}

TEST(PatchCover, RefusesWhatIsTooHighSomewhereOverTheTriangle) {
  EXPECT_FALSE(cover(slope(50, 0.5), 0.5).is_covered);
}

TEST(PatchCover, RefusesAPatchThatEndsOverTheTriangle) {
  EXPECT_TRUE(cover(slope(0.6, 0), 0.2).is_covered);
  EXPECT_FALSE(cover(slope(0.4, 0), 0.2).is_covered);
}

TEST(PatchCover, TakesWhatFacesAway) {
  TriangleMesh mesh = slope(50, 0);
  for (Triangle& f : mesh.faces)
    std::swap(f[0], f[1]);
  EXPECT_TRUE(cover(mesh, 1).is_covered);
}

TEST(PatchCover, TakesAFoldThatGoesOn) {
  const TriangleMesh mesh = drawn_along_y({{-50, 0.1}, {0.5, 0.1}, {0.2, 0.3}, {50, 0.3}});
  const PatchCover::CoverResult result = cover(mesh, 0.4);
  EXPECT_TRUE(result.is_covered);
  EXPECT_GE(result.height, 0.3);
}

TEST(PatchCover, RefusesAFoldThatEndsOverTheTriangle) {
  EXPECT_FALSE(cover(drawn_along_y({{-50, 0.1}, {0.5, 0.1}, {-50, 0.3}}), 0.4).is_covered);
}

TEST(PatchCover, MarksWhatLiesWhollyNearTheTriangle) {
  const std::array near = {Vec3{0.2, -0.1, 0.05}, Vec3{0.6, 0.1, 0.05}, Vec3{0.2, 0.3, 0.05}};
  const auto marked_and_height = [&](double sink) {
    TriangleMesh mesh{.positions = {near.begin(), near.end()}, .faces = {{0, 1, 2}}};
    mesh.positions[0].y -= sink;
    const TriangleBvh bvh(mesh);
    const WitnessSurface surface(bvh);
    PatchCover patches(surface);
    const double height = patches.cover(kTriangle, 7, 0, 0.25, 3).height;
    return std::pair(std::move(patches).overlaps(), height);
  };
  const auto [overlaps, height] = marked_and_height(0);
  EXPECT_EQ(overlaps.mark[0], 3);
  EXPECT_GE(height, std::hypot(0.1, 0.05));
  EXPECT_EQ(marked_and_height(0.3).first.mark[0], 0);
}

TEST(PatchCover, TellsWhichTriangleWasNear) {
  const TriangleBvh bvh(slope(50, 0));
  const WitnessSurface surface(bvh);
  PatchCover covered(surface), failed(surface);
  covered.cover(kTriangle, 7, 0, 0.2, 1);
  failed.cover(kTriangle, 7, 0, 0.05, 1);
  EXPECT_EQ(std::move(covered).overlaps().near(0), 7u);
  EXPECT_EQ(std::move(failed).overlaps().near(0), std::nullopt);
}

// Returns a wavy sheet around the origin. It has holes and partly folds over.
TriangleMesh crumpled(Dice& dice) {
  TriangleMesh mesh = sheet(12, 12);
  const auto unit = [&dice] { return dice.below(1'000'001) * 2e-6 - 1; };
  const double folds = dice.one_in(2) ? 0.2 : 1.5, waves = dice.one_in(2) ? 0.05 : 0.5;
  for (Vec3& p : mesh.positions)
    p = Vec3{p.x - 5.5 + folds * unit(), p.y - 5.5 + folds * unit(), waves * unit()} * 0.4;
  std::erase_if(mesh.faces, [&](const Triangle&) { return dice.one_in(200); });
  return mesh;
}

// The result's `height` must bound the distance of covered points. It must also bound the distance
// of points of marked triangles, even if the cover failed.
TEST(PatchCover, BoundsWhatItCoversAndMarks) {
  std::size_t covered = 0, marked_without_cover = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const auto unit = [&dice] { return dice.below(1'000'001) * 2e-6 - 1; };
    TriangleMesh mesh = crumpled(dice);
    const double thin = dice.one_in(4) ? 1e-3 : 1;
    const Vec3 turn{unit(), unit(), unit()};
    const double scale = std::array{1e-20, 1.0, 1e20}[dice.below(3)];
    // Reflects a point and scales it, which multiplies all distances by `scale`.
    const auto place = [&](const Vec3& p) {
      return (p - turn * (2 * dot(turn, p) / dot(turn, turn))) * scale;
    };
    const TrianglePoints triangle{place({unit(), unit(), 0}), place({unit(), unit(), 0.1 * unit()}),
                                  place({unit(), thin * unit(), 0})};
    for (Vec3& p : mesh.positions)
      p = place(p);
    const TriangleBvh bvh(mesh);
    const WitnessSurface surface(bvh);
    const Vec3 centre = (triangle.a + triangle.b + triangle.c) * (1.0 / 3);
    PatchCover patches(surface);
    const double limit = scale * (0.05 + 0.25 * std::abs(unit()));
    const auto result = patches.cover(triangle, 0, bvh.closest(centre).triangle, limit, 1);
    const double bound = result.height * (1 + 1e-12);
    if (result.is_covered) {
      ++covered;
      ASSERT_LE(dense_maximum(triangle, bvh), bound);
    }
    const TriangleBvh alone({.positions = {triangle.a, triangle.b, triangle.c},
                             .faces = {{0, 1, 2}},
                             .attributes = {}});
    const Overlaps overlaps = std::move(patches).overlaps();
    for (std::uint32_t t = 0; t < bvh.size(); ++t) {
      if (overlaps.mark[t] == 0) continue;
      marked_without_cover += result.is_covered ? 0 : 1;
      ASSERT_LE(dense_maximum(bvh.triangle(t), alone), bound);
    }
  }
  EXPECT_GT(covered, 300u);
  EXPECT_GT(marked_without_cover, 50u);
}

}  // namespace
}  // namespace vitrine::test
