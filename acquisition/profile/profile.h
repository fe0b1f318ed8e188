// SPDX-License-Identifier: Apache-2.0
// What one position of the table shows: points where the laser plane cuts the object.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/calibration/axis.h"
#include "codec/core/vec.h"

namespace vitrine {

enum PointFlag : std::uint8_t {
  kSaturated = 1,  // the stripe's peak is at the end of the camera's range
  kDouble = 2,     // another peak in the row is about as strong
  kFilled = 4,     // no measurement: between two ends of a gap
  kApart = 8,      // the surface does not continue from the point before it in the profile
  kSecond = 16,    // another surface that the row shows besides that of the point before it
};

struct ProfilePoint {
  TablePoint at;
  int row = 0;  // of the image, ascending within a profile; up to two points have the same
  std::uint8_t flags = 0;
};

struct Profile {
  double theta = 0;  // degrees by which the table has turned the object, counter-clockwise seen
                     // from above, in [0, 360)
  std::vector<ProfilePoint> points;
};

// In the frame of the object: z along the axis, mm; (rho, lateral, z) turned back by theta about z.
Vec3 position(const Profile& profile, const ProfilePoint& point);

}  // namespace vitrine
