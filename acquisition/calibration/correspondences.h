// SPDX-License-Identifier: Apache-2.0
// Reads pairs of an image point and its known position in the laser plane from CSV text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "acquisition/calibration/plane_map.h"

namespace vitrine::acquisition {

// Reads points from CSV. The first line is "u,v,x,y,pose"; each further line is one point, with u
// and v in pixels, x and y in mm, and an integer pose. Fails with kBadInput or kLimit, giving
// `name` and the line.
Expected<std::vector<Correspondence>> read_correspondences(std::string_view csv,
                                                           const std::string& name);

}  // namespace vitrine::acquisition
