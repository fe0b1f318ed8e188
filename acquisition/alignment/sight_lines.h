// SPDX-License-Identifier: Apache-2.0
// The ways that the light took to and from the measured points of a scan. No surface can lie on
// them.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/profile.h"
#include "codec/core/vec.h"

namespace vitrine::acquisition {

struct SightLine {
  Vec3 point;    // a measured point, in mm, in the frame of the scan
  Vec3 towards;  // unit vector from the point to the camera or to the laser
};

// Returns two lines for each of about `count` measured points, evenly chosen from all profiles: to
// the camera (see camera_place.h) and to the laser. A calibration knows the laser's plane, but not
// the laser's place in it: the laser is taken to be as high and as far from the axis as the camera.
// If the camera's place is unknown too, there is only the line to the laser, taken to be
// horizontal.
std::vector<SightLine> sight_lines(std::span<const Profile> profiles,
                                   const Calibration& calibration, std::size_t count);

}  // namespace vitrine::acquisition
