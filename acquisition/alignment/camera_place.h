// SPDX-License-Identifier: Apache-2.0
// Derives the camera's place from a calibration.
#pragma once

#include <optional>

#include "acquisition/calibration/calibration.h"

namespace vitrine::acquisition {

// Returns the centre of the camera in the axis's frame, in mm. A calibration stores only the map
// from picture to laser plane. Its perspective gives the focal length and the camera's pose
// ([Zhang00] section 3.1) if pixels are square and the optical axis meets the region's middle. So
// the result is approximate, most of all for a small region beside the sensor's middle. Returns
// nullopt if the map has no perspective, as if the camera faced the plane squarely.
std::optional<TablePoint> camera_place(const Calibration& calibration);

}  // namespace vitrine::acquisition
