// SPDX-License-Identifier: Apache-2.0
// Removes stray points from the stripe on the flat target. There the laser's line is straight once
// the lens's distortion is corrected. Stray points come from reflections, or from noise in rows
// where dark ink hides the line.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/light_plane.h"

namespace vitrine::acquisition {

struct StraightStripe {
  std::vector<LaserPoint> points;  // the input without the strays
  std::size_t strays = 0;          // number of points left out
  int unclear = 0;  // number of pictures left out because too many of their points were strays
};

// Removes a point if its distance from its picture's line exceeds both the stripe's width and six
// standard deviations of that picture's points. Nearer points belong to the line and are merely
// shifted by speckle and ink. Leaves out a whole picture if fewer than 10 points, or less than two
// thirds of its points, lie on the line. Fails with kBadInput if more than half of the pictures are
// left out. `points` are in the order of their pictures.
Expected<StraightStripe> straight_stripe(std::span<const LaserPoint> points,
                                         const CameraModel& camera);

}  // namespace vitrine::acquisition
