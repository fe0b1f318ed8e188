// SPDX-License-Identifier: Apache-2.0
#include "synthetic_scanner.h"
#include "support/product_names.h"

#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

namespace vitrine::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

CharucoTarget SyntheticScanner::target() {
  return {.squares_x = 9,
          .squares_y = 12,
          .square_mm = 8,
          .marker_mm = 6,
          .dictionary = "DICT_4X4_100"};
}

ImagePoint SyntheticScanner::project(const cv::Vec3d& at) const {
  std::vector<cv::Point2d> image;
  cv::projectPoints(std::vector<cv::Point3d>{cv::Point3d(at)}, cv::Vec3d(), cv::Vec3d(), matrix_,
                    distortion_, image);
  return {image[0].x, image[0].y};
}

cv::Vec3d SyntheticScanner::seen(double u, double v) const {
  std::vector<cv::Point2d> straight;
  cv::undistortPoints(std::vector<cv::Point2d>{{u, v}}, straight, matrix_, distortion_,
                      cv::noArray(), cv::noArray(), cv::TermCriteria(3, 100, 1e-14));
  const cv::Vec3d ray(straight[0].x, straight[0].y, 1);
  return ray * ((normal_.dot(on_axis_) + beside_) / normal_.dot(ray));
}

double SyntheticScanner::height(const cv::Vec3d& at) const {
  return up_.dot(at - on_axis_);
}

double SyntheticScanner::distance(const cv::Vec3d& at) const {
  return cv::norm(at - on_axis_ - height(at) * up_);
}

double SyntheticScanner::direction(const cv::Vec3d& at) const {
  const cv::Vec3d right = cv::normalize(cv::Vec3d(1, 0, 0) - up_ * up_[0]);
  const cv::Vec3d back = up_.cross(right);
  return std::atan2(back.dot(at - on_axis_), right.dot(at - on_axis_)) / kDegree;
}

cv::Affine3d SyntheticScanner::turned(double degrees) const {
  const cv::Affine3d rotation(up_ * (sense_ * degrees * kDegree));
  return cv::Affine3d(rotation.rotation(), on_axis_ - rotation.rotation() * on_axis_);
}

std::vector<ImagePoint> SyntheticScanner::corners(const cv::Affine3d& pose) const {
  std::vector<ImagePoint> all;
  const CharucoTarget t = target();
  for (int id = 0; id < (t.squares_x - 1) * (t.squares_y - 1); ++id) {
    const TargetPoint on = corner_on(t, id);
    all.push_back(project(pose * cv::Vec3d(on.x, on.y, 0)));
  }
  return all;
}

// Returns the image of the line in which the laser plane cuts the target.
std::vector<ImagePoint> SyntheticScanner::stripe(const cv::Affine3d& pose) const {
  const cv::Vec3d face = pose.rotation() * cv::Vec3d(0, 0, 1), centre = pose.translation();
  const cv::Vec3d along = cv::normalize(face.cross(normal_));
  cv::Vec3d on;  // a point in the laser plane and the target's plane, at the camera's height
  cv::solve(cv::Matx33d(face[0], face[1], face[2], normal_[0], normal_[1], normal_[2], 0, 1, 0),
            cv::Vec3d(face.dot(centre), normal_.dot(on_axis_) + beside_, 0), on);
  std::vector<ImagePoint> all;
  for (double t = -80; t < 80; t += 0.4) {
    const ImagePoint p = project(on + t * along);
    if (p.u >= 0 && p.v >= 0 && p.u <= kWidth - 1 && p.v <= kHeight - 1) all.push_back(p);
  }
  return all;
}

CalibrationInput SyntheticScanner::pictures(int placements, int angles,
                                            const ScannerNoise& noise) const {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const CharucoTarget t = target();
  CalibrationInput input{"CAM-1", {0, 0, kWidth, kHeight}, t, {}};
  for (int placement = 0; placement < placements; ++placement) {
    // Places the target's centre beside the axis. The target's x axis points to the right, and its
    // y axis points down or up.
    const double beside = placements == 1 ? 10 : -20 + 40.0 * placement / (placements - 1);
    const cv::Affine3d shift(cv::Matx33d::eye(), {-4.0 * t.squares_x, -4.0 * t.squares_y, 0});
    const cv::Affine3d lean(
        cv::Vec3d(0.1 * (placement % 3 - 1), 0.02 * placement, 0.03 * placement));
    const cv::Affine3d stands(cv::Matx33d::eye(), on_axis_ + cv::Vec3d(2, 2 * placement, beside));
    for (int i = 0; i < angles; ++i) {
      const double angle = angles == 1 ? 0 : -45 + 90.0 * i / (angles - 1);
      const double stood = angle + noise.table * normal(random);
      const cv::Affine3d pose = turned(stood) * stands * lean * shift;
      TargetPicture picture{.placement = placement, .angle = 100 + angle};
      const std::vector<ImagePoint> all = corners(pose);
      for (int id = 0; id < static_cast<int>(all.size()); ++id) {
        const ImagePoint p{all[id].u + noise.corner * normal(random),
                           all[id].v + noise.corner * normal(random)};
        if (p.u < 5 || p.v < 5 || p.u > kWidth - 6 || p.v > kHeight - 6) continue;
        picture.view.ids.push_back(id);
        picture.view.corners.push_back(p);
      }
      for (ImagePoint p : stripe(pose)) {
        p.u += noise.stripe * normal(random);
        picture.stripe.push_back(p);
      }
      input.pictures.push_back(std::move(picture));
    }
  }
  return input;
}

}  // namespace vitrine::test
