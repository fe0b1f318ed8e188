// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/axis.h"

#include <cmath>

namespace vitrine::acquisition {

// In the coordinates (x, y, normal), the axis runs along (b, 1, tilt) through (a, 0, offset). The
// rho direction is (1, -b, 0), which is perpendicular to the axis. The lateral direction is the
// cross product of the two.
TablePoint about(const TurntableAxis& axis, const PlanePoint& p) {
  const double dx = p.x - axis.a, dw = -axis.offset;
  const double in_plane = 1 + axis.b * axis.b, along = in_plane + axis.tilt * axis.tilt;
  const double up = axis.b * dx + p.y;
  return {.rho = (dx - axis.b * p.y) / std::sqrt(in_plane),
          .lateral = (axis.tilt * up - in_plane * dw) / std::sqrt(in_plane * along),
          .z = (up + axis.tilt * dw) / std::sqrt(along)};
}

}  // namespace vitrine::acquisition
