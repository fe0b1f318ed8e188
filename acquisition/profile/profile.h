// SPDX-License-Identifier: Apache-2.0
// A profile: the points where the laser plane cuts the object, at one position of the table.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/calibration/axis.h"
#include "codec/core/vec.h"

namespace vitrine::acquisition {

enum PointFlag : std::uint8_t {
  kSaturated = 1,  // the stripe's peak is at the end of the camera's range
  kDouble = 2,     // another peak in the row has similar strength
  kFilled = 4,     // interpolated across a gap, not measured
  kApart = 8,      // the surface does not continue from the preceding point of the profile
  kSecond = 16,    // belongs to a second surface in the same row
};

struct ProfilePoint {
  TablePoint at;
  int row = 0;  // image row, ascending within a profile; at most two points share a row
  std::uint8_t flags = 0;
};

struct Profile {
  // Angle in degrees by which the table has turned the object, in [0, 360), counter-clockwise seen
  // from above.
  double theta = 0;
  std::vector<ProfilePoint> points;
};

// Returns the point's position in mm in the object's frame, whose z runs along the axis: (rho,
// lateral, z) rotated back by theta about z.
Vec3 position(const Profile& profile, const ProfilePoint& point);

}  // namespace vitrine::acquisition
