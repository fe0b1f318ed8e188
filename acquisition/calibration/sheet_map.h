// SPDX-License-Identifier: Apache-2.0
// What the plane map is fitted to: the laser's sheet as camera and plane predict it, evenly over
// the part of the image where it was seen. Fitted to the single points of the stripe, it would
// follow their noise where they are few.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/light_plane.h"

namespace vitrine {

struct SheetArea {
  double margin = 0;  // pixels around the hull of the stripe's points
  int width = 0, height = 0;
};

std::vector<Correspondence> sheet_points(std::span<const LaserPoint> stripe,
                                         const CameraModel& camera, const LightPlane& plane,
                                         const SheetArea& area);

}  // namespace vitrine
