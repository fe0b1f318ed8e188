// SPDX-License-Identifier: Apache-2.0
// A simulated scanner with known parameters: camera with lens distortion, laser plane, and table.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <random>
#include <vector>

#include "acquisition/calibration/calibrate.h"
#include "support/product_names.h"

namespace vitrine::test {

struct ScannerNoise {
  double corner = 0.05;  // standard deviation of a corner's position, in pixels
  double stripe = 0.05;  // standard deviation of a stripe point across the stripe, in pixels
  double table = 0.05;   // standard deviation of the table's angle, in degrees
};

class SyntheticScanner {
 public:
  explicit SyntheticScanner(bool is_clockwise = false) : sense_(is_clockwise ? -1 : 1) {}

  static constexpr int kWidth = 1300, kHeight = 1030;
  static CharucoTarget target();

  // Returns pictures of the target in `placements` places on the table. Each place is shown at
  // `angles` angles of the table, around the angle at which the target faces the camera.
  CalibrationInput pictures(int placements, int angles, const ScannerNoise& noise) const;

  // Returns the point of the laser plane that a pixel sees, in mm in the camera's frame.
  cv::Vec3d seen(double u, double v) const;
  // Return a point's distance from the table's axis and its height along the axis, in mm.
  double distance(const cv::Vec3d& at) const;
  double height(const cv::Vec3d& at) const;
  // Returns the angle of a point around the axis, in degrees, in the table's sense of rotation.
  double direction(const cv::Vec3d& at) const;

 private:
  std::vector<acquisition::ImagePoint> corners(const cv::Affine3d& pose) const;
  std::vector<ImagePoint> stripe(const cv::Affine3d& pose) const;
  cv::Affine3d turned(double degrees) const;
  ImagePoint project(const cv::Vec3d& at) const;

  double sense_;
  cv::Matx33d matrix_{3020, 0, 660, 0, 3015, 505, 0, 0, 1};
  cv::Vec4d distortion_{-0.12, 0.15, 0.0006, -0.0004};
  // The table's axis points upwards, slightly inclined. It is 345 mm away from the camera.
  cv::Vec3d up_ = cv::normalize(cv::Vec3d(0.01, -1, 0.15)), on_axis_{1.5, 3, 345};
  // The laser plane passes the axis at a distance of 0.4 mm and is inclined to it. The angle
  // between plane and viewing direction is 28 degrees.
  cv::Vec3d normal_ = cv::normalize(cv::Vec3d(0.88, 0.02, -0.47));
  double beside_ = 0.4;
};

}  // namespace vitrine::test
