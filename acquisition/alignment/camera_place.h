// SPDX-License-Identifier: Apache-2.0
// Derives the camera's position from a calibration.
#pragma once

#include <optional>

#include "acquisition/calibration/calibration.h"

namespace vitrine::acquisition {

// Returns the position of the camera's centre in the frame of the table's axis, in mm. A
// calibration stores only the map from the picture to the laser plane. The perspective of this map
// determines the focal length and the camera's pose ([Zhang00] section 3.1), provided that pixels
// are square and the optical axis meets the middle of the sensor region (Calibration::region). The
// result is therefore approximate, above all if that region is small and far from the middle of the
// sensor. Returns nullopt if the map has no perspective, because the camera faces the plane
// squarely.
std::optional<TablePoint> camera_place(const Calibration& calibration);

}  // namespace vitrine::acquisition
