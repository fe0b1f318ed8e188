// SPDX-License-Identifier: Apache-2.0
// The laser's plane in the camera's frame, and a frame within it: x to the image's right, y to its
// top, its origin where the image's centre looks.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/axis.h"
#include "acquisition/calibration/scene.h"
#include "acquisition/calibration/target.h"

namespace vitrine {

struct LaserPoint {  // where the laser meets the target
  Pixel in_image;
  cv::Vec3d at;  // mm, camera's frame
  int pose = 0;  // of which picture
};

struct LightPlane {
  cv::Vec3d origin, x, y, normal;

  cv::Vec3d within(const cv::Vec3d& at) const;  // x, y, distance
  Axis axis(const TableAxis& table) const;
};

// Directions from the camera, of length 1.
std::vector<cv::Vec3d> rays(const CameraModel& camera, std::span<const Pixel> pixels);

// Where a ray from the camera meets the plane through `origin`; NaN where it hardly does.
cv::Vec3d meet(const cv::Vec3d& ray, const cv::Vec3d& origin, const cv::Vec3d& normal);

// Bears up to two fifths of the points lying elsewhere. Fails (kBadInput) where they determine no
// plane.
Expected<LightPlane> fit_light_plane(std::span<const LaserPoint> points, const CameraModel& camera,
                                     int width, int height);

}  // namespace vitrine
