// SPDX-License-Identifier: Apache-2.0
// Cuts a profile into windows that are short where it bends.
#pragma once

#include <span>
#include <vector>

#include "acquisition/profile/line_fit.h"
#include "acquisition/profile/profile.h"

namespace vitrine {

struct Window {
  std::size_t first = 0, count = 1;  // points
  LineFit line;                      // z over rho
};

struct WindowLimits {
  std::size_t windows = 1;  // join until there are no more than these
  std::size_t longest = 1;  // points
  double noise = 0;         // mm
};

// In order, without gaps or overlaps; none crosses a kApart.
std::vector<Window> adaptive_windows(std::span<const ProfilePoint> points,
                                     const WindowLimits& limits);

}  // namespace vitrine
