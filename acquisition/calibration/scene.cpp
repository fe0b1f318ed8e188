// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kLeastPictures = 6;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLeastTurn = 5 * kDegree, kLeastSpan = 20 * kDegree;
constexpr double kWorstMisfit = 1;  // largest accepted misfit() of a picture, in pixels

// Estimates the focal length from the homographies of the views. The principal point is set to the
// image's centre; the adjustment refines it later.
cv::Matx33d first_camera(std::span<const SeenTarget> seen, int width, int height) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> images;
  for (const SeenTarget& s : seen) {
    boards.emplace_back(s.on_board.begin(), s.on_board.end());
    images.emplace_back(s.in_image.begin(), s.in_image.end());
  }
  cv::Matx33d matrix = cv::initCameraMatrix2D(boards, images, {width, height});
  const double focal = matrix(0, 0);
  // Replaces an implausible focal length, which may result if all views are frontal.
  if (!(focal > 0.3 * width && focal < 30 * width)) {
    matrix(0, 0) = matrix(1, 1) = 2.5 * width;
  }
  return matrix;
}

cv::Affine3d first_pose(const CameraModel& camera, const SeenTarget& seen) {
  cv::Vec3d rotation, translation;
  cv::solvePnP(seen.on_board, seen.in_image, camera.matrix, camera.distortion, rotation,
               translation, false, cv::SOLVEPNP_IPPE);
  return cv::Affine3d(rotation, translation);
}

Expected<void> check_misfit(const CalibrationScene& scene, std::span<const SeenTarget> seen,
                            const char* next_step) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double worst = misfit(scene, seen[i], i);
    if (worst <= kWorstMisfit) continue;
    return fail(
        ErrorCode::kBadInput,
        fmt::format(
            "picture {} of the target is {:.1f} pixels off the prediction from the others; {}",
            i + 1, worst, next_step));
  }
  return {};
}

// Estimates the camera and a separate placement for each picture, with the table's angle taken as 0
// in all pictures. cv::calibrateCamera works the same way.
Expected<CalibrationScene> without_axis(std::span<const SeenTarget> seen, int width, int height) {
  std::vector<SeenTarget> single(seen.begin(), seen.end());
  CalibrationScene scene;
  scene.camera.matrix = first_camera(seen, width, height);
  for (std::size_t i = 0; i < single.size(); ++i) {
    single[i].placement = static_cast<int>(i);
    single[i].angle = 0;
    scene.placements.push_back(first_pose(scene.camera, single[i]));
    scene.slips.push_back(0);
  }
  adjust(scene, single, Adjust::kPlacements);
  if (auto ok =
          check_misfit(scene, single, "check that the target is flat and described as printed");
      !ok) {
    return tl::unexpected(ok.error());
  }
  return scene;
}

struct Turned {  // a pair of pictures of one placement, at different angles
  cv::Affine3d from, to;
  double angle;
};

std::vector<Turned> turns_of(std::span<const SeenTarget> seen, const CalibrationScene& single) {
  std::vector<Turned> turns;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t j = i + 1; j < seen.size(); ++j) {
      const double angle = std::remainder(seen[j].angle - seen[i].angle, 2 * std::numbers::pi);
      const double size = std::abs(angle);
      if (seen[i].placement != seen[j].placement || size < kLeastTurn ||
          size > std::numbers::pi - kLeastTurn) {
        continue;
      }
      turns.push_back({single.placements[i], single.placements[j], angle});
    }
  }
  return turns;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Estimates the direction of the table's axis. Each pair of poses of the target, at two angles of
// the table, gives one estimate. Takes the median, which a few wrong pairs do not affect.
cv::Vec3d direction_of(std::span<const Turned> turns) {
  cv::Vec3d direction;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const Turned& t : turns) {
      const cv::Affine3d between(t.to.rotation() * t.from.rotation().t());
      values.push_back(between.rvec()[c] / t.angle);
    }
    direction[c] = median(std::move(values));
  }
  return cv::normalize(direction);
}

// Returns the point of the table's axis that is level with the target. Rotations of the table do
// not move this point.
cv::Vec3d fixed_point(std::span<const Turned> turns, const cv::Vec3d& direction) {
  const int rows = 3 * static_cast<int>(turns.size());
  cv::Mat_<double> a(rows + 1, 3), b(rows + 1, 1), point;
  for (int i = 0; i < static_cast<int>(turns.size()); ++i) {
    const cv::Matx33d rotation = turn({direction, {}}, turns[i].angle).rotation();
    cv::Mat(cv::Matx33d::eye() - rotation).copyTo(a.rowRange(3 * i, 3 * i + 3));
    cv::Mat(turns[i].to.translation() - rotation * turns[i].from.translation())
        .copyTo(b.rowRange(3 * i, 3 * i + 3));
  }
  cv::Mat(direction.t()).copyTo(a.row(rows));
  b(rows) = direction.dot(turns.front().from.translation());
  cv::solve(a, b, point, cv::DECOMP_SVD);
  return {point(0), point(1), point(2)};
}

CalibrationScene joined(std::span<const SeenTarget> seen, const CalibrationScene& single,
                        const CameraFrameAxis& axis) {
  CalibrationScene scene{single.camera, axis, {}, std::vector<double>(seen.size(), 0)};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto placement = static_cast<std::size_t>(seen[i].placement);
    if (placement >= scene.placements.size()) scene.placements.resize(placement + 1);
    scene.placements[placement] = turn(axis, -seen[i].angle) * single.placements[i];
  }
  return scene;
}

}  // namespace

cv::Affine3d turn(const CameraFrameAxis& axis, double angle) {
  const cv::Affine3d rotation(axis.direction * angle);
  return cv::Affine3d(rotation.rotation(), axis.point - rotation.rotation() * axis.point);
}

cv::Affine3d CalibrationScene::pose(const SeenTarget& seen, std::size_t picture) const {
  return turn(axis, seen.angle + slips[picture]) * placements[seen.placement];
}

Expected<CalibrationScene> solve_scene(std::span<const SeenTarget> seen, int width, int height) {
  if (seen.size() < kLeastPictures) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the target was seen in {} pictures, a calibration needs at least {}; "
                            "show it in more poses",
                            seen.size(), kLeastPictures));
  }
  const auto single = without_axis(seen, width, height);
  if (!single) return single;
  const std::vector<Turned> turns = turns_of(seen, *single);
  const auto span = [](const Turned& t) { return std::abs(t.angle); };
  if (turns.size() < 3 || span(std::ranges::max(turns, {}, span)) < kLeastSpan) {
    return fail(ErrorCode::kBadInput,
                "the table's axis is not determined: stand the target on the table and take at "
                "least 3 pictures of it at angles 20 degrees apart or more, without touching it");
  }
  const cv::Vec3d direction = direction_of(turns);
  CalibrationScene scene = joined(seen, *single, {direction, fixed_point(turns, direction)});
  adjust(scene, seen, Adjust::kAll);
  if (auto ok = check_misfit(scene, seen,
                             "check that the target stood still on the table while it turned, and "
                             "that the table turned to the commanded angles");
      !ok) {
    return tl::unexpected(ok.error());
  }
  return scene;
}

}  // namespace vitrine::acquisition
