// SPDX-License-Identifier: Apache-2.0
// Where the table's axis is, seen from the laser plane, and what a point of the plane is about it.
#pragma once

#include "acquisition/calibration/plane_map.h"

namespace vitrine {

// The axis as a line over the height y of the laser plane: x = a + b y, and at the distance offset
// + tilt y from the plane, positive towards its normal x × y. In eq. 1 of the paper offset and tilt
// are 0: there the axis lies in the plane.
struct Axis {
  double a = 0, b = 0;          // mm, mm per mm
  double offset = 0, tilt = 0;  // mm, mm per mm
  bool clockwise = false;       // seen from above, for angles of the board that grow
};

// About the axis: z along it, upwards, from where it meets y = 0; rho perpendicular to it within
// the laser plane, signed (the paper's reading: negative means theta + 180 degrees); lateral to
// both, so that (rho, lateral, z) is right-handed.
struct TablePoint {
  double rho = 0, lateral = 0, z = 0;  // mm
};

TablePoint about(const Axis& axis, const PlanePoint& p);

}  // namespace vitrine
