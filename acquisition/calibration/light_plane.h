// SPDX-License-Identifier: Apache-2.0
// The laser plane in the camera's frame, and a frame within that plane: x points to the image's
// right, y to its top. The origin is the point at which the optical axis meets the plane.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/axis.h"
#include "acquisition/calibration/scene.h"
#include "acquisition/calibration/target.h"

namespace vitrine::acquisition {

struct LaserPoint {  // a point of the laser's line on the target
  ImagePoint in_image;
  cv::Vec3d at;  // position in the camera's frame, in mm
  int pose = 0;  // index of the picture that shows the point
};

struct LightPlane {
  cv::Vec3d origin, x, y, normal;

  // Returns a point's coordinates in the plane's frame: x, y, and the distance from the plane, in
  // mm.
  cv::Vec3d within(const cv::Vec3d& at) const;
  TurntableAxis axis(const CameraFrameAxis& table) const;
};

// Returns the unit directions from the camera through the pixels.
std::vector<cv::Vec3d> rays(const CameraModel& camera, std::span<const ImagePoint> pixels);

// Intersects a ray from the camera with the plane through `origin`. Returns NaN if ray and plane
// are nearly parallel.
cv::Vec3d meet(const cv::Vec3d& ray, const cv::Vec3d& origin, const cv::Vec3d& normal);

// Fits the light plane to the points. Up to two fifths of them may be outliers. Fails with
// kBadInput if the points do not determine a plane.
Expected<LightPlane> fit_light_plane(std::span<const LaserPoint> points, const CameraModel& camera,
                                     int width, int height);

}  // namespace vitrine::acquisition
