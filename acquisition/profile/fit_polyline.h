// SPDX-License-Identifier: Apache-2.0
// Moves the corners of a polyline so that it fits the points it approximates.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

struct PolylineVertex {
  ProfilePoint point;
  // The corner's position along the points: a fractional index. Indices ascend from corner to
  // corner.
  double index = 0;
};

// Moves each corner perpendicular to the polyline, in the plane of rho and z, to minimise the sum
// of squared distances to the points. Without this correction, a polyline through means lies on the
// inner side of each bend. Takes O(points) time.
void fit_polyline(std::span<const ProfilePoint> points, std::span<PolylineVertex> corners);

}  // namespace vitrine::acquisition
