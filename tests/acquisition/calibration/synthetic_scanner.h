// SPDX-License-Identifier: Apache-2.0
// A scanner whose every parameter is known: camera with distortion, laser plane, table.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <random>
#include <vector>

#include "acquisition/calibration/calibrate.h"

namespace vitrine::test {

struct ScannerNoise {
  double corner = 0.05;  // pixels
  double stripe = 0.05;  // pixels, across the stripe
  double table = 0.05;   // degrees
};

class SyntheticScanner {
 public:
  explicit SyntheticScanner(bool clockwise = false) : sense_(clockwise ? -1 : 1) {}

  static constexpr int kWidth = 1300, kHeight = 1030;
  static Target target();

  // `placements` of the target on the table, each seen at `angles` around the one that faces the
  // camera.
  CalibrationInput pictures(int placements, int angles, const ScannerNoise& noise) const;

  // Of the camera's frame, mm: where a pixel looks at the laser plane.
  cv::Vec3d seen(double u, double v) const;
  // Where a point of the camera's frame is about the table's axis: distance, height along it above
  // that of `from`, and the angle around it.
  double distance(const cv::Vec3d& at) const;
  double height(const cv::Vec3d& at) const;
  // The direction, in degrees, of a point around the axis, as the table counts.
  double direction(const cv::Vec3d& at) const;

 private:
  std::vector<Pixel> corners(const cv::Affine3d& pose) const;
  std::vector<Pixel> stripe(const cv::Affine3d& pose) const;
  cv::Affine3d turned(double degrees) const;
  Pixel project(const cv::Vec3d& at) const;

  double sense_;
  cv::Matx33d matrix_{3020, 0, 660, 0, 3015, 505, 0, 0, 1};
  cv::Vec4d distortion_{-0.12, 0.15, 0.0006, -0.0004};
  // The table's axis: upwards, a little inclined, 345 mm away.
  cv::Vec3d up_ = cv::normalize(cv::Vec3d(0.01, -1, 0.15)), on_axis_{1.5, 3, 345};
  // The laser's plane passes 0.4 mm beside the axis, inclined to it, 28 degrees from the view.
  cv::Vec3d normal_ = cv::normalize(cv::Vec3d(0.88, 0.02, -0.47));
  double beside_ = 0.4;
};

}  // namespace vitrine::test
