// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/axis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

using V = std::array<double, 3>;

double dot(const V& p, const V& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
V cross(const V& p, const V& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
V unit(const V& p) {
  const double length = std::sqrt(dot(p, p));
  return {p[0] / length, p[1] / length, p[2] / length};
}

TEST(TurntableAxis, WithinThePlaneIsThePapersEquation) {
  const TurntableAxis axis{.a = 3, .b = 0.1};
  const TablePoint p = about(axis, {20, 50});
  const double root = std::sqrt(1.01);
  EXPECT_DOUBLE_EQ(p.rho, (20 - 3 - 0.1 * 50) / root);
  EXPECT_DOUBLE_EQ(p.z, (50 + 0.1 * (20 - 3)) / root);
  EXPECT_EQ(p.lateral, 0);
}

TEST(TurntableAxis, ThatLeavesThePlaneIsResolvedIntoAFrameOfItsOwn) {
  const TurntableAxis axis{.a = 3, .b = 0.1, .offset = -0.7, .tilt = 0.03};
  const V up = unit({axis.b, 1, axis.tilt}), outwards = unit({1, -axis.b, 0});
  const V aside = cross(up, outwards);
  for (const PlanePoint& p : {PlanePoint{20, 50}, {-31, 7}, {3, 0}}) {
    const V from_axis = {p.x - axis.a, p.y, -axis.offset};
    const TablePoint t = about(axis, p);
    EXPECT_NEAR(t.rho, dot(from_axis, outwards), 1e-12);
    EXPECT_NEAR(t.lateral, dot(from_axis, aside), 1e-12);
    EXPECT_NEAR(t.z, dot(from_axis, up), 1e-12);
  }
}

TEST(TurntableAxis, ItselfIsAtNoDistance) {
  const TurntableAxis axis{.a = 3, .b = 0.1, .offset = 0, .tilt = 0};
  const TablePoint p = about(axis, {3 + 0.1 * 40, 40});
  EXPECT_NEAR(p.rho, 0, 1e-12);
  EXPECT_NEAR(p.z, 40 * std::sqrt(1.01), 1e-12);
}

}  // namespace
}  // namespace vitrine::acquisition
