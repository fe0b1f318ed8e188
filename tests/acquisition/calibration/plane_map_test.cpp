// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/plane_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

constexpr int kColumns = 1300, kRows = 1030;

// Returns the true position of a pixel in a laser plane that is seen at 30 degrees. Together, x and
// y contain every kind of cubic term, with small coefficients.
PlanePoint truth(double u, double v) {
  const double s = u / 650 - 1, t = v / 515 - 1;
  return {60 * s + 4 * s * t - 1.5 * s * s * s + 0.3 * s * s * t + 2,
          -50 * t + 2 * t * t + 0.8 * t * t * t - 0.2 * s * t * t + 40};
}

std::vector<Correspondence> grid(double from_u, double to_u, double from_v, double to_v) {
  std::vector<Correspondence> points;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const double u = from_u + (to_u - from_u) * i / 20, v = from_v + (to_v - from_v) * j / 20;
      points.push_back({u, v, truth(u, v), i});
    }
  }
  return points;
}

TEST(PlaneMap, RecoversTheCubicItWasMadeFrom) {
  for (int degree = 3; degree <= 5; ++degree) {
    const auto map = PlaneMap::fit(grid(200, 1100, 0, 1029), degree, kColumns, kRows);
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_EQ(map->degree(), degree);
    for (const auto& [u, v] : {std::pair{321.25, 517.5}, {200.0, 0.0}, {1099.9, 1028.9}}) {
      const auto p = map->at(u, v);
      ASSERT_TRUE(p);
      EXPECT_NEAR(p->x, truth(u, v).x, 1e-9);
      EXPECT_NEAR(p->y, truth(u, v).y, 1e-9);
    }
  }
}

TEST(PlaneMap, IsFittedInNormalisedCoordinates) {
  const auto map = PlaneMap::fit(grid(200, 1100, 0, 1029), 3, kColumns, kRows);
  ASSERT_TRUE(map);
  EXPECT_GT(map->condition(), 1);
  EXPECT_LT(map->condition(), 12);  // above 1e8 if coordinates were not normalised
}

TEST(PlaneMap, RefusesPointsOutsideTheHullOfWhatItSaw) {
  const auto map = PlaneMap::fit(grid(200, 1100, 100, 900), 3, kColumns, kRows);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->hull().size(), 8u);
  for (const auto& [u, v] : {std::pair{200.0, 100.0}, {1100.0, 900.0}, {600.0, 900.0}})
    EXPECT_TRUE(map->at(u, v)) << u << ' ' << v;
  for (const auto& [u, v] : {std::pair{199.9, 500.0},
                             {1100.1, 500.0},
                             {600.0, 99.9},
                             {600.0, 900.1},
                             {std::nan(""), 500.0}}) {
    EXPECT_FALSE(map->at(u, v)) << u << ' ' << v;
  }
  EXPECT_FALSE(PlaneMap().at(0, 0));
}

TEST(PlaneMap, SaysWhyItCannotBeFitted) {
  const auto points = grid(200, 1100, 100, 900);
  const auto message = [&](std::span<const Correspondence> from, int degree) {
    const auto map = PlaneMap::fit(from, degree, kColumns, kRows);
    return map ? "fitted" : map.error().message;
  };
  EXPECT_THAT(message(points, 6), HasSubstr("choose 2 to 5"));
  EXPECT_THAT(message(std::span(points).first(9), 3), HasSubstr("9 points do not determine"));
  EXPECT_THAT(message(grid(500, 500, 100, 900), 3), HasSubstr("cover too little"));
  EXPECT_THAT(message(grid(500, 500, 500, 500), 2), HasSubstr("cover too little"));
  EXPECT_THAT(message(grid(200, 1400, 100, 900), 3), HasSubstr("outside the image of 1300 x 1030"));
}

}  // namespace
}  // namespace vitrine::acquisition
