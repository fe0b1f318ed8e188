// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/light_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 1300, kHeight = 1030;

CameraModel camera() {
  return {cv::Matx33d(3000, 0, 650, 0, 3000, 515, 0, 0, 1), {}};
}

// Returns points scattered over the plane through (0, 0, 350) with the given normal. Every fifth
// point is `stray` mm away from the plane.
std::vector<LaserPoint> points_on(const cv::Vec3d& normal, double stray) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-40, 40);
  const cv::Vec3d first = cv::normalize(normal.cross(cv::Vec3d(1, 2, 3)));
  const cv::Vec3d second = normal.cross(first);
  std::vector<LaserPoint> points;
  for (int i = 0; i < 500; ++i) {
    const cv::Vec3d at =
        cv::Vec3d(0, 0, 350) + anywhere(random) * first + anywhere(random) * second;
    points.push_back({{}, i % 5 == 0 ? at + stray * normal : at, i % 10});
  }
  return points;
}

TEST(LightPlane, IsFoundAmongPointsThatAreElsewhere) {
  const cv::Vec3d normal = cv::normalize(cv::Vec3d(0.87, 0.05, -0.5));
  const auto plane = fit_light_plane(points_on(normal, 15), camera(), kWidth, kHeight);
  ASSERT_TRUE(plane) << plane.error().message;
  EXPECT_NEAR(plane->normal.dot(normal), 1, 1e-12);
  EXPECT_NEAR(plane->within({0, 0, 350})[2], 0, 1e-9);
}

TEST(LightPlane, HasAFrameToTheRightAndUpwards) {
  const cv::Vec3d normal = cv::normalize(cv::Vec3d(-0.87, 0.05, 0.5));
  const auto plane = fit_light_plane(points_on(normal, 0), camera(), kWidth, kHeight);
  ASSERT_TRUE(plane) << plane.error().message;
  EXPECT_NEAR(cv::norm(plane->x.cross(plane->y) - plane->normal), 0, 1e-12);
  EXPECT_GT(plane->x[0], 0);
  EXPECT_LT(plane->y[1], -0.9);
}

TEST(LightPlane, ResolvesTheAxisIntoItsFrame) {
  LightPlane plane;
  plane.origin = {5, 6, 300};
  plane.x = {1, 0, 0};
  plane.y = {0, -1, 0};
  plane.normal = {0, 0, -1};
  const CameraFrameAxis axis{cv::normalize(cv::Vec3d(-0.1, 1, 0.02)), {8, 26, 299}};
  // In the plane's coordinate frame, this axis passes through the point (3, -20, 1).
  const TurntableAxis found = plane.axis(axis);
  EXPECT_TRUE(found.is_clockwise);
  EXPECT_NEAR(found.b, 0.1, 1e-12);
  EXPECT_NEAR(found.tilt, 0.02, 1e-12);
  EXPECT_NEAR(found.a, 3 + 20 * 0.1, 1e-12);
  EXPECT_NEAR(found.offset, 1 + 20 * 0.02, 1e-12);
}

TEST(LightPlane, SaysWhyThereIsNone) {
  const auto message = [](const std::vector<LaserPoint>& points) {
    const auto plane = fit_light_plane(points, camera(), kWidth, kHeight);
    return plane ? "fitted" : plane.error().message;
  };
  const cv::Vec3d upright = cv::normalize(cv::Vec3d(0.87, 0.05, -0.5));
  std::vector<LaserPoint> points = points_on(upright, 0);
  points.resize(99);
  EXPECT_THAT(message(points), HasSubstr("too little of the laser line is seen"));
  points = points_on(upright, 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].at = {0, 0.1 * static_cast<double>(i), 350};
  EXPECT_THAT(message(points), HasSubstr("the same place"));
  EXPECT_THAT(message(points_on(cv::normalize(cv::Vec3d(0.01, 1, -0.4)), 0)),
              HasSubstr("is not upright"));
}

}  // namespace
}  // namespace vitrine::acquisition
