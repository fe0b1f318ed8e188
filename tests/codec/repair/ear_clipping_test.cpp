// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/triangulate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

namespace vitrine {
namespace {

using Polygon = std::vector<FlatCorner>;

FlatCorner on_circle(double turn, double radius) {
  const double angle = 2 * std::numbers::pi * turn;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Polygon numbered(Polygon polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    polygon[i].vertex = static_cast<std::uint32_t>(i);
  return polygon;
}

Polygon circle(int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i)
    polygon.push_back(on_circle(i / double(corners), 100));
  return numbered(polygon);
}

Polygon star(int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i)
    polygon.push_back(on_circle(i / double(corners), i % 2 == 0 ? 100 : 30));
  return numbered(polygon);
}

// A band that winds around the centre ten times. Its outline runs outwards along one side of the
// band, and back along the other.
Polygon spiral(int corners) {
  Polygon polygon;
  const int half = corners / 2;
  for (int i = 0; i < half; ++i)
    polygon.push_back(on_circle(10.0 * i / half, 10 + 90.0 * i / half + 3));
  for (int i = half; i-- > 0;)
    polygon.push_back(on_circle(10.0 * i / half, 10 + 90.0 * i / half));
  return numbered(polygon);
}

// A comb with slanted teeth that are much longer than wide.
Polygon comb(int corners) {
  Polygon polygon{{0, -1}, {100, -1}};
  for (int i = corners - 2; i-- > 0;)
    polygon.push_back({100.0 * i / corners + (i % 2 == 1 ? 40 : 0), i % 2 == 1 ? 50.0 : 0.0});
  return numbered(polygon);
}

// Returns a polygon like a coastline: its radii are the sum of waves with random phases, which
// depend on `seed`.
Polygon coast(int corners, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
  std::vector<double> phases(12);
  std::ranges::generate(phases, [&] { return phase(random); });
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    double radius = 10;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const double waves = std::exp2(k);
      radius += 4 / std::sqrt(waves) *
                std::sin(waves * 2 * std::numbers::pi * i / corners + phases[k]) / 3;
    }
    polygon.push_back(on_circle(i / double(corners), radius));
  }
  return numbered(polygon);
}

// Returns twice the area that the polygon encloses.
double enclosed(const Polygon& p) {
  double total = 0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    total += signed_area(p[0], p[i], p[i + 1]);
  return total;
}

std::uint64_t n_log_n(const Polygon& polygon) {
  return polygon.size() * static_cast<std::uint64_t>(std::bit_width(polygon.size()));
}

// Expects that the triangles cover the polygon once.
void expect_covered(const Polygon& p, const std::vector<Triangle>& triangles) {
  ASSERT_EQ(triangles.size(), p.size() - 2);
  double total = 0;
  int turned = 0;
  for (const auto& [a, b, c] : triangles) {
    const double area = signed_area(p[a], p[b], p[c]);
    turned += area < 0 ? 1 : 0;
    total += area;
  }
  EXPECT_EQ(turned, 0);
  EXPECT_NEAR(total, enclosed(p), 1e-9 * enclosed(p));
}

// Returns the largest number of triangles at a corner.
std::uint32_t largest_valence(const Polygon& polygon, const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> valence(polygon.size());
  for (const Triangle& t : triangles) {
    for (const std::uint32_t corner : t)
      ++valence[corner];
  }
  return *std::ranges::max_element(valence);
}

TEST(EarClipping, CoversPolygonsOfManyCornersInAboutNLogNSteps) {
  constexpr int kCorners = 20'000;
  for (const Polygon& polygon : {circle(kCorners), star(kCorners), spiral(kCorners), comb(kCorners),
                                 coast(kCorners, 1), coast(kCorners, 2)}) {
    std::vector<Triangle> triangles;
    const std::uint64_t steps = clip_ears(polygon, triangles);
    expect_covered(polygon, triangles);
    EXPECT_LT(steps, 4 * n_log_n(polygon));
  }
}

TEST(EarClipping, GivesNoCornerOfAConvexPolygonManyTriangles) {
  const Polygon polygon = circle(20'000);
  std::vector<Triangle> triangles;
  clip_ears(polygon, triangles);
  EXPECT_LE(largest_valence(polygon, triangles), 40u);
}

TEST(EarClipping, LeavesOutCornersOnAStraightSide) {
  Polygon square;
  for (int i = 0; i < 400; ++i)
    square.push_back({static_cast<double>(i % 200), i < 200 ? 0.0 : 10.0});
  std::reverse(square.begin() + 200, square.end());
  square = numbered(square);
  std::vector<Triangle> triangles;
  clip_ears(square, triangles);
  expect_covered(square, triangles);
  EXPECT_EQ(std::ranges::count_if(triangles,
                                  [&](const Triangle& t) {
                                    return signed_area(square[t[0]], square[t[1]], square[t[2]]) ==
                                           0;
                                  }),
            0);
}

// Random corners form a polygon that intersects itself almost everywhere.
TEST(EarClipping, EndsForAPolygonThatIntersectsItself) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  Polygon polygon(20'000);
  for (FlatCorner& corner : polygon)
    corner = {place(random), place(random)};
  polygon = numbered(polygon);
  std::vector<Triangle> triangles;
  const std::uint64_t steps = clip_ears(polygon, triangles);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  EXPECT_LT(steps, 65 * n_log_n(polygon));
  std::vector<Triangle> flat;
  clip_ears(numbered(Polygon(1'000)), flat);
  EXPECT_EQ(flat.size(), 998u);
}

}  // namespace
}  // namespace vitrine
