// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/axis.h"

#include <cmath>

namespace vitrine::acquisition {

// Returns `p` in the axis's frame. In the coordinates (x, y, normal), the axis has the direction
// (b, 1, tilt) and contains (a, 0, offset). The rho direction is (1, -b, 0), perpendicular to the
// axis. The lateral direction is the cross product of rho and the axis.
TablePoint about(const TurntableAxis& axis, const PlanePoint& p) {
  const double dx = p.x - axis.a, dw = -axis.offset;
  const double in_plane = 1 + axis.b * axis.b, along = in_plane + axis.tilt * axis.tilt;
  const double up = axis.b * dx + p.y;
  return {.rho = (dx - axis.b * p.y) / std::sqrt(in_plane),
          .lateral = (axis.tilt * up - in_plane * dw) / std::sqrt(in_plane * along),
          .z = (up + axis.tilt * dw) / std::sqrt(along)};
}

}  // namespace vitrine::acquisition
