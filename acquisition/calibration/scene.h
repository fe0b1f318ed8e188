// SPDX-License-Identifier: Apache-2.0
// Estimates the camera, the table's axis and the target's placements from pictures of the target on
// the turning table. Pictures of one placement differ only by a rotation about the table's axis.
// All pictures have the same axis.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <span>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct CameraModel {  // pinhole camera, in pixels, with OpenCV's distortion k1, k2, p1, p2
  cv::Matx33d matrix = cv::Matx33d::eye();
  cv::Vec4d distortion;
};

// The table's axis in the camera's frame, in mm. The table turns about `direction` by the
// right-hand rule as its angle grows.
struct CameraFrameAxis {
  cv::Vec3d direction{0, 1, 0}, point;
};

struct SeenTarget {
  int placement = 0;  // index of the placement, from 0, without gaps
  double angle = 0;   // the table's angle, in radians
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> in_image;
};

struct CalibrationScene {
  CameraModel camera;
  CameraFrameAxis axis;
  std::vector<cv::Affine3d>
      placements;  // transforms from target to camera frame, with the table at 0 degrees
  // For each picture, the table's true angle minus the reported one, in radians.
  std::vector<double> slips;

  cv::Affine3d pose(const SeenTarget& seen, std::size_t picture) const;
};

// Returns the rotation by `angle` radians about `axis`, in the camera's frame.
cv::Affine3d turn(const CameraFrameAxis& axis, double angle);

enum class Adjust {
  kPlacements,  // adjusts camera and placements
  kAll,         // also adjusts the table's axis and the slips
};

// Adjusts the scene by least squares over the corners' positions in the image. Single outliers have
// little effect. `scene` must hold approximate values on entry.
void adjust(CalibrationScene& scene, std::span<const SeenTarget> seen, Adjust what);

// Returns the median distance, in pixels, between the corners seen in one picture and those that
// the scene predicts.
double misfit(const CalibrationScene& scene, const SeenTarget& seen, std::size_t picture);

// Estimates the whole scene from the corners. Fails with kBadInput if the pictures do not determine
// the scene or contradict each other.
Expected<CalibrationScene> solve_scene(std::span<const SeenTarget> seen, int width, int height);

}  // namespace vitrine::acquisition
