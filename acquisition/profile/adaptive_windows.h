// SPDX-License-Identifier: Apache-2.0
// Divides a profile into windows of consecutive points. Windows are short where the profile bends.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/line_fit.h"
#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

struct Window {
  std::size_t first = 0, count = 1;  // index of the first point; number of points
  LineFit line;                      // fits z as a function of rho
};

struct WindowLimits {
  // Windows are merged until at most this many are left.
  std::size_t windows = 1;
  std::size_t longest = 1;  // largest number of points in a window
  double noise = 0;         // standard deviation of the points' noise, in mm
};

// Returns the windows in ascending order, without gaps or overlaps. A point that is flagged kApart
// begins a new window, because the surface does not continue from the point before it.
std::vector<Window> adaptive_windows(std::span<const ProfilePoint> points,
                                     const WindowLimits& limits);

}  // namespace vitrine::acquisition
