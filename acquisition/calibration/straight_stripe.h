// SPDX-License-Identifier: Apache-2.0
// On the flat target the laser's line is straight, once the lens' distortion is taken away. What
// was found off it is not the laser's line: noise in a row where ink hides the line, or a
// reflection.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/light_plane.h"

namespace vitrine {

struct StraightStripe {
  std::vector<LaserPoint> points;  // as given but for the strays
  std::size_t strays = 0;          // points left out
  int unclear = 0;                 // pictures left out, whose points all count as strays
};

// Leaves out what is farther from its picture's line than six standard deviations of that picture's
// points, and farther than the stripe is wide: what is nearer is the line, moved by speckle and
// ink, and is to be judged. Leaves out a picture wholly where fewer than 10 points or less than two
// thirds of them are on the line. Fails (kBadInput) where that befalls more than half of the
// pictures. `points` are in the order of their pictures.
Expected<StraightStripe> straight_stripe(std::span<const LaserPoint> points,
                                         const CameraModel& camera);

}  // namespace vitrine
