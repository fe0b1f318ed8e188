// SPDX-License-Identifier: Apache-2.0
// How far single points of the stripe scatter: on the flat target it is a straight line.
#pragma once

#include <span>

#include "acquisition/calibration/light_plane.h"
#include "acquisition/calibration/plane_map.h"

namespace vitrine {

// mm: the standard deviation across the stripe, from the median of the deviations in x.
double stripe_noise(std::span<const LaserPoint> stripe, const PlaneMap& map);

}  // namespace vitrine
