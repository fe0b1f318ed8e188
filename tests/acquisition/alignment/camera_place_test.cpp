// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/camera_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "acquisition/alignment/sight_lines.h"

namespace vitrine::acquisition {
namespace {

constexpr double kFocal = 3'000;  // focal length in pixels
// Position of the camera, in mm: x and y in the laser plane, then the distance from the laser
// plane.
const Vec3 kCamera = {250, 60, 160};
constexpr int kWidth = 1'300, kHeight = 1'030;  // size of a picture, in pixels

// Returns the calibration of a camera without distortion that looks at the axis.
Calibration calibration() {
  const Vec3 ahead = kCamera * (-1 / length(kCamera));
  Vec3 right = cross(ahead, {0, 1, 0});
  right = right * (1 / length(right));
  const Vec3 down = cross(ahead, right);
  std::vector<Correspondence> points;
  for (double x = -40; x <= 40; x += 5) {
    for (double y = -40; y <= 40; y += 5) {
      const Vec3 d = Vec3{x, y, 0} - kCamera;
      points.push_back({kWidth / 2. + kFocal * dot(d, right) / dot(d, ahead),
                        kHeight / 2. + kFocal * dot(d, down) / dot(d, ahead),
                        {x, y}});
    }
  }
  Calibration made;
  made.region = {0, 0, kWidth, kHeight};
  made.map = *PlaneMap::fit(points, 5, kWidth, kHeight);
  made.axis = {.offset = .2};
  return made;
}

TEST(CameraPlace, FollowsFromThePerspectiveOfTheMap) {
  const auto place = camera_place(calibration());
  ASSERT_TRUE(place.has_value());
  // Here the turntable's axis is parallel to y. Therefore rho equals x, and the lateral coordinate
  // points against the laser plane's normal.
  EXPECT_NEAR(place->rho, kCamera.x, 3);
  EXPECT_NEAR(place->z, kCamera.y, 3);
  EXPECT_NEAR(place->lateral, -(kCamera.z - .2), 3);
}

TEST(SightLines, LeadFromEachPointToLaserAndCamera) {
  const Profile profile{.theta = 90, .points = {{.at = {.rho = 10, .lateral = 0, .z = 60}}}};
  const auto lines = sight_lines(std::span(&profile, 1), calibration(), 100);
  ASSERT_EQ(lines.size(), 2U);
  const Vec3 at = position(profile, profile.points[0]);
  for (const SightLine& line : lines) {
    EXPECT_EQ(line.point, at);
    EXPECT_NEAR(length(line.towards), 1, 1e-9);
    EXPECT_NEAR(line.towards.z, 0, .02);  // the camera is as high as the point
  }
  // The laser shines along the profile's half plane. The camera looks at this plane from the side.
  EXPECT_NEAR(dot(lines[0].towards, at) / std::hypot(at.x, at.y), 1, 1e-3);
  EXPECT_NEAR(dot(lines[1].towards, at) / std::hypot(at.x, at.y), 240 / std::hypot(240, 160), .02);
}

}  // namespace
}  // namespace vitrine::acquisition
