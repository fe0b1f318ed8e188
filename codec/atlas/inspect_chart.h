// SPDX-License-Identifier: Apache-2.0
// Tests whether a flattened chart is good enough to carry a texture.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

struct ChartFaults {
  bool overlaps = false;  // more than 0.2 % of the chart is covered twice
  // Indices, within the chart, of faces that are flipped, or whose area in the plane is less than
  // 1/8 or more than 6 times their area in space.
  std::vector<std::uint32_t> bad_faces;

  bool none() const { return !overlaps && bad_faces.empty(); }
};

ChartFaults inspect(const Chart& chart);

// Returns the share of the chart's pixels that more than one face covers. Uses about 40 pixels per
// face.
double overlapping_share(const Chart& chart);

}  // namespace vitrine::inline codec
