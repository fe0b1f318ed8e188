// SPDX-License-Identifier: Apache-2.0
// Points of the laser plane that were measured by other means, as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "acquisition/calibration/plane_map.h"

namespace vitrine {

// CSV: the line "u,v,x,y,pose", then one point a line (pixels, mm, whole number). Fails (kBadInput,
// kLimit) naming `name` and the line.
Expected<std::vector<Correspondence>> read_correspondences(std::string_view csv,
                                                           const std::string& name);

}  // namespace vitrine
