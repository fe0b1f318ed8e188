// SPDX-License-Identifier: Apache-2.0
// The table's axis relative to the laser plane, and the coordinates of a laser point relative to
// the axis.
#pragma once

#include "acquisition/calibration/plane_map.h"

namespace vitrine::acquisition {

// The table's axis in the frame of the laser plane, as a function of the height y. At height y, the
// axis is at x = a + b y, and its distance from the plane is offset + tilt y. The distance is
// positive in the direction of the plane's normal, x × y. [WLL] eq. 1 assumes that the axis lies in
// the plane: offset = tilt = 0.
struct TurntableAxis {
  double a = 0, b = 0;          // a in mm, b in mm per mm
  double offset = 0, tilt = 0;  // offset in mm, tilt in mm per mm
  // Whether the table, seen from above, turns clockwise when the angle that the motor board reports
  // grows.
  bool is_clockwise = false;
};

// A point in the axis's frame. z runs upwards along the axis and is 0 at y = 0. rho lies in the
// laser plane, perpendicular to the axis. A negative rho means -rho at theta + 180 degrees, as in
// [WLL] eq. 1. (rho, lateral, z) is a right-handed orthogonal frame.
struct TablePoint {
  double rho = 0, lateral = 0, z = 0;  // all in mm
};

TablePoint about(const TurntableAxis& axis, const PlanePoint& p);

}  // namespace vitrine::acquisition
