// SPDX-License-Identifier: Apache-2.0
// Sight lines: the straight paths of the light from the laser to the measured points of a scan, and
// from these points to the camera. No surface can cross these paths.
#pragma once

#include <span>
#include <vector>

#include "acquisition/calibration/calibration.h"
#include "acquisition/profile/profile.h"
#include "codec/core/vec.h"

namespace vitrine::acquisition {

struct SightLine {
  Vec3 point;    // a measured point, in mm, in the scan's frame
  Vec3 towards;  // unit vector from the point to the camera or to the laser
};

// Returns two lines for each of about `count` measured points, taken at regular intervals from all
// profiles: one to the camera (see camera_place.h) and one to the laser. A calibration determines
// the laser's plane, but not the laser's position in the plane. The laser is therefore assumed to
// be as high and as far from the axis as the camera. If the camera's position is unknown too, there
// is only the line to the laser, which is then assumed to be horizontal.
std::vector<SightLine> sight_lines(std::span<const Profile> profiles,
                                   const Calibration& calibration, std::size_t count);

}  // namespace vitrine::acquisition
