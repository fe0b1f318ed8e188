// SPDX-License-Identifier: Apache-2.0
#include "codec/build/snap_atlas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

struct Flat {
  std::vector<Triangle> faces;
  std::vector<Vec2> at;
};

// Returns a flat grid of n x n squares. Each square has sides of length `side` and consists of two
// triangles.
Flat grid(std::uint32_t n, double side) {
  Flat flat;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i)
      flat.at.push_back({i * side, j * side});
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      flat.faces.push_back({a, a + 1, b + 1});
      flat.faces.push_back({a, b + 1, b});
    }
  }
  return flat;
}

double doubled_area(const Triangle& f, const std::vector<Vec2>& at) {
  return cross(at[f[1]] - at[f[0]], at[f[2]] - at[f[0]]);
}

std::vector<Vec2> real(const std::vector<Vec2i>& at) {
  std::vector<Vec2> out;
  for (const Vec2i& p : at)
    out.push_back(to_vec2(p));
  return out;
}

TEST(SnapAtlas, CoordinatesGoToTheNearestPointOfALatticeThatSuitsTheEdges) {
  const Flat flat = grid(8, 3000.3);
  const SnappedCoordinates snapped = snap_coordinates(flat.faces, flat.at);
  EXPECT_EQ(snapped.step, 64);
  for (std::size_t w = 0; w < flat.at.size(); ++w) {
    EXPECT_EQ(snapped.at[w].x % 64, 0);
    EXPECT_EQ(snapped.at[w].y % 64, 0);
    EXPECT_LE(std::abs(snapped.at[w].x - flat.at[w].x), 32);
    EXPECT_LE(std::abs(snapped.at[w].y - flat.at[w].y), 32);
  }
}

TEST(SnapAtlas, LargeFacesDoNotMakeTheStepLargerThanTheGutterAllows) {
  const Flat flat = grid(2, 400'000);
  EXPECT_EQ(snap_coordinates(flat.faces, flat.at).step, 1024);
}

// Squeezes some columns of a grid together, so that most of their faces are thinner than a step of
// the lattice.
TEST(SnapAtlas, NoFaceIsTurnedOverOrLosesItsArea) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    Flat flat = grid(12, 4000);
    for (Vec2& p : flat.at) {
      p = p + Vec2{dice.below(1000) * 1.0, dice.below(1000) * 1.0};
      if (p.x > 20'000 && p.x < 30'000) p.x = 20'000 + (p.x - 20'000) * 0.02;
    }
    const SnappedCoordinates snapped = snap_coordinates(flat.faces, flat.at);
    EXPECT_GT(snapped.step, 1);
    const auto after = real(snapped.at);
    for (const Triangle& face : flat.faces) {
      if (doubled_area(face, flat.at) > 0) {
        EXPECT_GT(doubled_area(face, after), 0);
      }
    }
  }
}

TEST(SnapAtlas, AFaceThatWasTurnedOverBeforeDoesNotMakeTheStepSmaller) {
  Flat flat = grid(8, 3000);
  std::swap(flat.faces[7][0], flat.faces[7][1]);
  EXPECT_EQ(snap_coordinates(flat.faces, flat.at).step, 64);
}

}  // namespace
}  // namespace vitrine::test
