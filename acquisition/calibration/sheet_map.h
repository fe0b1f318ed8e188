// SPDX-License-Identifier: Apache-2.0
// Generates the points to which the plane map is fitted. The points are evenly spaced over the part
// of the image in which the stripe was seen. Their positions in the light plane are computed from
// camera and plane. A fit to the measured points would follow their noise in regions with few
// points.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/light_plane.h"

namespace vitrine::acquisition {

struct SheetArea {
  // The points extend this many pixels beyond the hull of the stripe's points.
  double margin = 0;
  int width = 0, height = 0;
};

std::vector<Correspondence> sheet_points(std::span<const LaserPoint> stripe,
                                         const CameraModel& camera, const LightPlane& plane,
                                         const SheetArea& area);

}  // namespace vitrine::acquisition
