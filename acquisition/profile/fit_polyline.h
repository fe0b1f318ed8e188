// SPDX-License-Identifier: Apache-2.0
// Moves the corners of a polyline so that it lies in the middle of the points it stands for.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/profile.h"

namespace vitrine {

struct Corner {
  ProfilePoint point;
  double index = 0;  // of the points: where along them it is, ascending
};

// Each corner moves across the polyline, in the plane of rho and z, so that the sum of the squared
// distances of the points from it is least: a chord between means of what is bent lies on its inner
// side. O(points).
void fit_polyline(std::span<const ProfilePoint> points, std::span<Corner> corners);

}  // namespace vitrine
