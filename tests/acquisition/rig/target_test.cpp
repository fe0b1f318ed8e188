// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "acquisition/rig_optics/renderer.h"

namespace vitrine::acquisition::rig {
namespace {

struct Corner {
  int id = 0;
  ImagePoint at;
};

// Returns the corners that OpenCV finds in a picture without knowing the camera.
std::vector<Corner> detect(const Frame& frame) {
  const cv::Mat image(frame.height, frame.width, CV_8U,
                      const_cast<std::uint8_t*>(frame.pixels.data()));
  const TargetSpec spec;
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_100);
  const auto board = cv::aruco::CharucoBoard::create(
      spec.squares_x, spec.squares_y, static_cast<float>(spec.square_mm),
      static_cast<float>(spec.marker_mm), dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids, corner_ids;
  std::vector<cv::Point2f> corners;
  cv::aruco::detectMarkers(image, dictionary, markers, ids);
  if (!ids.empty())
    cv::aruco::interpolateCornersCharuco(markers, ids, image, board, corners, corner_ids);
  // OpenCV 4.6 finds the corners half a pixel too far right and down. cornerSubPix() corrects that.
  if (!corners.empty()) cv::cornerSubPix(image, corners, {6, 6}, {-1, -1}, {3, 30, 1e-3});
  std::vector<Corner> found;
  for (std::size_t i = 0; i < corners.size(); ++i)
    found.push_back({corner_ids[i], {corners[i].x, corners[i].y}});
  return found;
}

// Returns the position of an inner corner in the sheet's coordinates. OpenCV counts corners from
// the top left.
Vec3 on_sheet(int id) {
  const TargetSpec spec;
  const int column = id % (spec.squares_x - 1), row = id / (spec.squares_x - 1);
  return {(column + 1 - spec.squares_x / 2.0) * spec.square_mm,
          (spec.squares_y / 2.0 - row - 1) * spec.square_mm, 0};
}

Vec3 in_world(const SubjectFrame& placement, const Vec3& p) {
  return placement.origin + placement.x * p.x + placement.y * p.y + placement.z * p.z;
}

Frame dark_frame(std::uint64_t seed, int pose, double degrees = 0) {
  return Renderer(optics_of(seed), nullptr, {.seed = seed})
      .take({{.degrees = degrees, .target = pose}});
}

TEST(Target, OpenCvFindsEveryPoseWithItsCornersWhereTheyAre) {
  constexpr std::uint64_t kSeed = 2;
  const Lens camera = optics_of(kSeed).camera;
  Renderer renderer(optics_of(kSeed), nullptr, {.seed = kSeed});
  const auto poses = target_poses(kSeed);
  for (int pose = 0; pose < kHeldPoses; ++pose) {
    const auto corners = detect(renderer.take({{.target = pose}}));
    EXPECT_GE(corners.size(), 40U) << pose;
    double squares = 0, right = 0, down = 0;
    for (const Corner& corner : corners) {
      const ImagePoint truth = *project(
          camera, in_world(poses[static_cast<std::size_t>(pose)].frame, on_sheet(corner.id)));
      right += corner.at.u - truth.u;
      down += corner.at.v - truth.v;
      squares += std::pow(corner.at.u - truth.u, 2) + std::pow(corner.at.v - truth.v, 2);
    }
    const auto count = static_cast<double>(corners.size());
    EXPECT_LT(std::sqrt(squares / count), 0.3) << pose;
    EXPECT_LT(std::hypot(right, down) / count, 0.06) << pose;
  }
}

TEST(Target, ThePoseOnTheTableTurnsWithItAndOthersDoNot) {
  const Optics optics = optics_of(2);
  const auto poses = target_poses(2);
  const SubjectFrame turned = on_table(optics, 30, poses[kHeldPoses].frame);
  const auto corners = detect(dark_frame(2, kHeldPoses, 30));
  ASSERT_GE(corners.size(), 30U);
  for (const Corner& corner : corners) {
    const ImagePoint truth = *project(optics.camera, in_world(turned, on_sheet(corner.id)));
    EXPECT_NEAR(corner.at.u, truth.u, 3) << corner.id;  // 3 pixels allow for the motor's error
    EXPECT_NEAR(corner.at.v, truth.v, 3) << corner.id;
  }
  const auto held = detect(dark_frame(2, 0, 0)), still = detect(dark_frame(2, 0, 30));
  ASSERT_FALSE(still.empty());
  EXPECT_EQ(held[0].id, still[0].id);
  EXPECT_NEAR(held[0].at.u, still[0].at.u, 0.5);
}

TEST(Target, ThePoseOnTheTableIsSeenAtThreeOrMoreOfTwelveAngles) {
  Renderer renderer(optics_of(2), nullptr, {.seed = 2});
  int seen = 0;
  for (int step = 0; step < 12; ++step)
    seen += detect(renderer.take({{.degrees = step * 30.0, .target = kHeldPoses}})).size() >= 12;
  EXPECT_GE(seen, 3);
}

// The poses together cover all places at which an object of 80 mm may show the stripe.
TEST(Target, TheLaserCrossesEveryPoseAndTheyCoverTheVolume) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Optics optics = optics_of(seed);
    double nearest = 1e9, farthest = -1e9, lowest = 1e9, highest = -1e9;
    for (const TargetPose& pose : target_poses(seed)) {
      if (pose.stands_on_table) continue;
      const LaserSheet laser = optics_in(pose.frame, optics).laser;
      const PrintedTarget target;
      int lit = 0;
      // Visits points of the line in which the sheet cuts the target. y is the height on the
      // target.
      for (double y = -55; y <= 55; y += 5) {
        const double x = (laser.offset - laser.normal.y * y) / laser.normal.x;
        const Vec3 at = in_world(pose.frame, {x, y, 0});
        const auto pixel = project(optics.camera, at);
        if (std::abs(x) > 35 || !pixel || pixel->v < 0 || pixel->v > kSensorHeight - 1) continue;
        ++lit;
        nearest = std::min(nearest, at.x);
        farthest = std::max(farthest, at.x);
        lowest = std::min(lowest, at.z);
        highest = std::max(highest, at.z);
      }
      EXPECT_GE(lit, 10);
    }
    EXPECT_LT(nearest, -45);
    EXPECT_GT(farthest, 45);
    EXPECT_LT(lowest, -2);
    EXPECT_GT(highest, 82);
  }
}

TEST(Target, TheStripeOnItIsBrightAndRarelySaturated) {
  Renderer renderer(optics_of(1), nullptr, {.seed = 1});
  const Frame lit = renderer.take({{.is_laser_on = true, .target = 12}});
  const Frame dark = renderer.take({{.is_laser_on = false, .target = 12}});
  int bright = 0, saturated = 0;
  for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
    bright += lit.pixels[i] - dark.pixels[i] > 60;
    saturated += lit.pixels[i] == 255;
  }
  EXPECT_GT(bright, 200);
  EXPECT_LT(saturated, bright / 10);
}

}  // namespace
}  // namespace vitrine::acquisition::rig
