// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/profile_of.h"

#include <gmock/gmock.h>

namespace vitrine::acquisition {
namespace {

// Returns a calibration for the pixels from (100, 100) to (300, 500), at 0.1 mm per pixel: x = (u -
// 200) / 10 and y = (500 - v) / 10.
Calibration known(const TurntableAxis& axis = {}) {
  std::vector<Correspondence> points;
  for (int v = 100; v <= 500; v += 50) {
    for (int u = 100; u <= 300; u += 25)
      points.push_back({double(u), double(v), {(u - 200) / 10.0, (500 - v) / 10.0}});
  }
  return {.map = PlaneMap::fit(points, 2, 640, 640).value(), .axis = axis};
}

double theta_of(double angle, bool is_clockwise) {
  return profile_of({}, known({.is_clockwise = is_clockwise}), angle).theta;
}

TEST(ProfileOf, ItsAngleGrowsCounterClockwiseFromZeroToAWholeTurn) {
  EXPECT_DOUBLE_EQ(theta_of(90, false), 90);
  EXPECT_DOUBLE_EQ(theta_of(90, true), 270);
  EXPECT_DOUBLE_EQ(theta_of(-30, false), 330);
  EXPECT_DOUBLE_EQ(theta_of(-30, true), 30);
  EXPECT_DOUBLE_EQ(theta_of(3600.5, false), 0.5);
  for (const bool is_clockwise : {false, true}) {
    for (const double turn : {-360, 0, 360, 720})
      EXPECT_EQ(theta_of(turn, is_clockwise), 0) << turn;
  }
}

TEST(ProfileOf, AHairLessThanNothingIsNothingNotAWholeTurn) {
  EXPECT_EQ(theta_of(-1e-15, false), 0);
  EXPECT_EQ(theta_of(1e-15, true), 0);
}

TEST(ProfileOf, EachPointIsAboutTheAxisAndKeepsItsRowAndFlags) {
  const StripePoint stripe[] = {{.row = 200, .u = 250, .flags = kSaturated},
                                {.row = 300, .u = 150.5, .flags = kDouble}};
  const TurntableAxis axis{.a = 1, .offset = 2, .tilt = 0.1};
  const Profile profile = profile_of(stripe, known(axis), 0);
  ASSERT_EQ(profile.points.size(), 2U);
  const PlanePoint expected[] = {{5, 30}, {-4.95, 20}};
  for (std::size_t i = 0; i < 2; ++i) {
    const TablePoint at = about(axis, expected[i]);
    EXPECT_NEAR(profile.points[i].at.rho, at.rho, 1e-9);
    EXPECT_NEAR(profile.points[i].at.lateral, at.lateral, 1e-9);
    EXPECT_NEAR(profile.points[i].at.z, at.z, 1e-9);
    EXPECT_EQ(profile.points[i].row, stripe[i].row);
    EXPECT_EQ(profile.points[i].flags, stripe[i].flags);
  }
}

// [WLL] eq. 1: if the axis lies upright in the laser plane, rho = x - a and z = y.
TEST(ProfileOf, AnUprightAxisInTheLaserPlaneIsTheOneOfThePaper) {
  const StripePoint stripe[] = {{.row = 400, .u = 170}};
  const Profile profile = profile_of(stripe, known({.a = 1.5}), 0);
  ASSERT_EQ(profile.points.size(), 1U);
  EXPECT_NEAR(profile.points[0].at.rho, -4.5, 1e-9);
  EXPECT_NEAR(profile.points[0].at.lateral, 0, 1e-9);
  EXPECT_NEAR(profile.points[0].at.z, 10, 1e-9);
}

TEST(ProfileOf, PointsOutsideTheCalibratedRegionAreLeftOut) {
  const StripePoint stripe[] = {{.row = 99, .u = 200},  {.row = 100, .u = 200},
                                {.row = 300, .u = 99},  {.row = 301, .u = 301},
                                {.row = 500, .u = 300}, {.row = 501, .u = 200}};
  std::vector<int> rows;
  for (const ProfilePoint& point : profile_of(stripe, known(), 0).points)
    rows.push_back(point.row);
  EXPECT_THAT(rows, testing::ElementsAre(100, 500));
  EXPECT_TRUE(profile_of(stripe, Calibration{}, 0).points.empty());
}

}  // namespace
}  // namespace vitrine::acquisition
