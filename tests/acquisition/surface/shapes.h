// SPDX-License-Identifier: Apache-2.0
// Scans of shapes with a known surface.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

// Returns rho, in mm, at an angle about the axis (radians) and a height (mm). Returns nullopt if
// there is no surface.
using Shape = std::function<std::optional<double>(double angle, double z)>;

struct Scanned {
  int profiles = 90, rows = 60;
  double top = 30, bottom = 0;  // heights of the first and last row, in mm
  double noise = 0;             // noise of rho, in mm
  std::uint64_t seed = 1;
};

std::vector<Profile> scan_of(const Shape& shape, const Scanned& how = {});

Shape cylinder(double radius);
// An ellipsoid with its centre on the axis at `height`. `across` and `up` are its half axes. All
// values are in mm.
Shape ellipsoid(double across, double up, double height);
Shape box(double half);

}  // namespace vitrine::acquisition
