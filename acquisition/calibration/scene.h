// SPDX-License-Identifier: Apache-2.0
// Camera, table and target, as pictures of the target on the turning table determine them: the
// pictures of one placement differ by a turn about the one axis, which ties all of them together.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <span>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

struct CameraModel {  // pinhole, with OpenCV's k1, k2, p1, p2; pixels
  cv::Matx33d matrix = cv::Matx33d::eye();
  cv::Vec4d distortion;
};

struct TableAxis {  // in the camera's frame, mm; growing angles turn the table right-handed about
                    // it
  cv::Vec3d direction{0, 1, 0}, point;
};

struct SeenTarget {
  int placement = 0;  // from 0, without gaps
  double angle = 0;   // radians, of the table
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> in_image;
};

struct Scene {
  CameraModel camera;
  TableAxis axis;
  std::vector<cv::Affine3d> placements;  // from target to camera, with the table at 0
  std::vector<double> slips;  // radians, of each picture: how much further the table stood

  cv::Affine3d pose(const SeenTarget& seen, std::size_t picture) const;
};

// By a turn about `axis`, of the camera's frame.
cv::Affine3d turn(const TableAxis& axis, double angle);

enum class Adjust {
  kPlacements,  // camera and placements
  kAll,         // axis and slips, too
};

// Least squares over the corners' positions in the image, robust against single corners that are
// off. Needs a scene that is roughly right.
void adjust(Scene& scene, std::span<const SeenTarget> seen, Adjust what);

// Root mean square in pixels, of one picture.
double misfit(const Scene& scene, const SeenTarget& seen, std::size_t picture);

// Fails (kBadInput) where the pictures do not determine the scene or contradict each other.
Expected<Scene> solve_scene(std::span<const SeenTarget> seen, int width, int height);

}  // namespace vitrine
