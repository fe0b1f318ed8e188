// SPDX-License-Identifier: Apache-2.0
// Measures the scatter of single stripe points on the flat target, where the stripe is a straight
// line.
#pragma once

#include <span>

#include "acquisition/calibration/light_plane.h"
#include "acquisition/calibration/plane_map.h"

namespace vitrine::acquisition {

// Returns the standard deviation of a stripe point across the stripe, in mm. It is computed from
// the median of the deviations in x.
double stripe_noise(std::span<const LaserPoint> stripe, const PlaneMap& map);

}  // namespace vitrine::acquisition
