// SPDX-License-Identifier: Apache-2.0
// Refines the calibration by the Levenberg-Marquardt method, over all pictures at once. The
// residuals of a picture depend only on the camera, the axis, and that picture's placement and slip
// (the error of the table's angle). The normal equations are therefore summed picture by picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "acquisition/calibration/scene.h"

namespace vitrine::acquisition {
namespace {

// Standard deviation of a corner's position, in pixels.
constexpr double kCornerNoise = 0.05;
// Standard deviation of the error of the table's angle, in radians, with a stepper motor.
constexpr double kSlipNoise = 0.05 * std::numbers::pi / 180;
// Residuals beyond this many standard deviations count linearly instead of squared (Huber's loss).
constexpr double kRobust = 4;

// The unknowns that determine one picture.
struct PictureUnknowns {
  CameraModel camera;
  CameraFrameAxis axis;
  cv::Affine3d placement;
  double slip = 0;
};
constexpr int kCamera = 8, kPose = 6, kAxis = 4;
// Numbers of unknowns of one picture. kFree counts those that Adjust::kPlacements adjusts: camera
// and placement. kPart counts all of them.
constexpr int kFree = kCamera + kPose;
constexpr int kPart = kFree + kAxis + 1;
using Deltas = cv::Vec<double, kPart>;
// Steps by which the unknowns are varied to estimate the derivatives.
constexpr std::array<double, kPart> kSteps = {
    // Camera: fx fy cx cy k1 k2 p1 p2.
    0.1, 0.1, 0.1, 0.1, 1e-4, 1e-3, 1e-5, 1e-5,
    // Placement: rotation, translation.
    1e-5, 1e-5, 1e-5, 1e-3, 1e-3, 1e-3,
    // Axis (direction, then point), then slip.
    1e-5, 1e-5, 1e-2, 1e-2, 1e-5};

cv::Vec3d across(const cv::Vec3d& direction) {
  const cv::Vec3d other = std::abs(direction[0]) < 0.5 ? cv::Vec3d(1, 0, 0) : cv::Vec3d(0, 0, 1);
  return cv::normalize(direction.cross(other));
}

CameraModel moved(const CameraModel& from, const Deltas& by) {
  CameraModel camera = from;
  camera.matrix(0, 0) += by[0];
  camera.matrix(1, 1) += by[1];
  camera.matrix(0, 2) += by[2];
  camera.matrix(1, 2) += by[3];
  for (int i = 0; i < 4; ++i)
    camera.distortion[i] += by[4 + i];
  return camera;
}

// Returns the axis changed by four unknowns: two change its direction, two shift its point. A line
// in space has four degrees of freedom.
CameraFrameAxis moved(const CameraFrameAxis& from, const Deltas& by) {
  const cv::Vec3d first = across(from.direction), second = from.direction.cross(first);
  return {cv::normalize(from.direction + by[14] * first + by[15] * second),
          from.point + by[16] * first + by[17] * second};
}

cv::Affine3d moved(const cv::Affine3d& from, const Deltas& by) {
  const cv::Affine3d rotation(cv::Vec3d(by[8], by[9], by[10]));
  return cv::Affine3d(rotation.rotation() * from.rotation(),
                      from.translation() + cv::Vec3d(by[11], by[12], by[13]));
}

PictureUnknowns moved(const PictureUnknowns& from, const Deltas& by) {
  return {moved(from.camera, by), moved(from.axis, by), moved(from.placement, by),
          from.slip + by[18]};
}

std::vector<cv::Point2d> project(const PictureUnknowns& part, const SeenTarget& seen) {
  const cv::Affine3d pose = turn(part.axis, seen.angle + part.slip) * part.placement;
  std::vector<cv::Point2d> image;
  cv::projectPoints(seen.on_board, pose.rvec(), pose.translation(), part.camera.matrix,
                    part.camera.distortion, image);
  return image;
}

// Returns the residuals, each divided by its standard deviation: two for each corner, then one for
// the slip.
cv::Mat_<double> errors(const PictureUnknowns& part, const SeenTarget& seen) {
  const std::vector<cv::Point2d> image = project(part, seen);
  cv::Mat_<double> all(static_cast<int>(2 * image.size() + 1), 1);
  int row = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    all(row++) = (image[i].x - seen.in_image[i].x) / kCornerNoise;
    all(row++) = (image[i].y - seen.in_image[i].y) / kCornerNoise;
  }
  all(row) = part.slip / kSlipNoise;
  return all;
}

double loss(const cv::Mat_<double>& all) {
  double sum = 0;
  for (const double e : all) {
    const double size = std::abs(e);
    sum += size <= kRobust ? e * e : kRobust * (2 * size - kRobust);
  }
  return sum;
}

class Problem {
 public:
  Problem(std::span<const SeenTarget> seen, Adjust what)
      : seen_(seen), free_(what == Adjust::kAll ? kPart : kFree) {}

  double cost(const CalibrationScene& scene) const {
    double sum = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      sum += loss(errors(part(scene, i), seen_[i]));
    return sum;
  }

  // Sums the normal equations A d = -g over all pictures.
  void linearise(const CalibrationScene& scene, cv::Mat_<double>& a, cv::Mat_<double>& g) const {
    const int size = kCamera + kAxis + kPose * static_cast<int>(scene.placements.size()) +
                     static_cast<int>(seen_.size());
    a = cv::Mat_<double>::zeros(size, size);
    g = cv::Mat_<double>::zeros(size, 1);
    for (std::size_t i = 0; i < seen_.size(); ++i)
      add(scene, i, a, g);
  }

  CalibrationScene moved_by(const CalibrationScene& scene, const cv::Mat_<double>& d) const {
    CalibrationScene to = scene;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const auto at = places(scene, i);
      Deltas by;
      for (int k = 0; k < kPart; ++k)
        by[k] = d(at[k]);
      const PictureUnknowns p = moved(part(scene, i), by);
      to.camera = p.camera;
      to.axis = p.axis;
      to.placements[seen_[i].placement] = p.placement;
      to.slips[i] = p.slip;
    }
    return to;
  }

 private:
  PictureUnknowns part(const CalibrationScene& scene, std::size_t i) const {
    return {scene.camera, scene.axis, scene.placements[seen_[i].placement], scene.slips[i]};
  }

  // Returns the indices of the unknowns that determine picture `i`, among the unknowns of the whole
  // scene.
  std::array<int, kPart> places(const CalibrationScene& scene, std::size_t i) const {
    std::array<int, kPart> at{};
    const int poses = kCamera + kAxis;
    std::iota(at.begin(), at.begin() + kCamera, 0);
    std::iota(at.begin() + kCamera, at.begin() + kFree, poses + kPose * seen_[i].placement);
    std::iota(at.begin() + kFree, at.end() - 1, kCamera);
    at.back() = poses + static_cast<int>(kPose * scene.placements.size() + i);
    return at;
  }

  void add(const CalibrationScene& scene, std::size_t i, cv::Mat_<double>& a,
           cv::Mat_<double>& g) const {
    const PictureUnknowns here = part(scene, i);
    const cv::Mat_<double> e = errors(here, seen_[i]);
    cv::Mat_<double> jacobian(e.rows, free_);
    for (int k = 0; k < free_; ++k) {
      Deltas by;
      by[k] = kSteps[k];
      const cv::Mat_<double> more = errors(moved(here, by), seen_[i]);
      const cv::Mat_<double> less = errors(moved(here, -by), seen_[i]);
      jacobian.col(k) = (more - less) / (2 * kSteps[k]);
    }
    cv::Mat_<double> weighted = jacobian.clone();
    for (int row = 0; row < e.rows; ++row)
      weighted.row(row) *= std::min(1.0, kRobust / std::max(std::abs(e(row)), 1e-9));
    const cv::Mat_<double> square(weighted.t() * jacobian), gradient(weighted.t() * e);
    const auto at = places(scene, i);
    for (int k = 0; k < free_; ++k) {
      g(at[k]) += gradient(k);
      for (int l = 0; l < free_; ++l)
        a(at[k], at[l]) += square(k, l);
    }
  }

  std::span<const SeenTarget> seen_;
  // Number of unknowns that are adjusted for each picture. The equations of the remaining unknowns
  // stay zero.
  int free_;
};

}  // namespace

void adjust(CalibrationScene& scene, std::span<const SeenTarget> seen, Adjust what) {
  constexpr int kMostSteps = 100;
  constexpr double kConverged = 1e-8, kMostDamping = 1e9;
  const Problem problem(seen, what);
  double cost = problem.cost(scene), damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    cv::Mat_<double> a, g, d;
    problem.linearise(scene, a, g);
    double next = cost;
    for (; damping < kMostDamping; damping *= 10) {
      cv::Mat_<double> damped = a.clone();
      for (int k = 0; k < a.rows; ++k)
        damped(k, k) += damping * std::max(a(k, k), 1e-6);
      if (!cv::solve(damped, -g, d, cv::DECOMP_CHOLESKY)) continue;
      CalibrationScene to = problem.moved_by(scene, d);
      next = problem.cost(to);
      if (!(next < cost)) continue;
      scene = std::move(to);
      damping = std::max(damping / 10, 1e-9);
      break;
    }
    if (!(next < cost * (1 - kConverged))) return;
    cost = next;
  }
}

double misfit(const CalibrationScene& scene, const SeenTarget& seen, std::size_t picture) {
  const PictureUnknowns part{scene.camera, scene.axis, scene.placements[seen.placement],
                             scene.slips[picture]};
  const std::vector<cv::Point2d> image = project(part, seen);
  std::vector<double> distances;
  for (std::size_t i = 0; i < image.size(); ++i)
    distances.push_back(cv::norm(image[i] - seen.in_image[i]));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

}  // namespace vitrine::acquisition
