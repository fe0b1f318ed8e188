// SPDX-License-Identifier: Apache-2.0
// Tests whether a flattened chart is fit to carry a picture.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

struct ChartFaults {
  bool overlaps = false;  // more than 0.2 % of the chart is covered twice
  // Indices, within the chart, of faces that are flipped or have an area ratio outside 1/8 to 6.
  std::vector<std::uint32_t> bad_faces;

  bool none() const { return !overlaps && bad_faces.empty(); }
};

ChartFaults inspect(const Chart& chart);

// Returns the share of the chart's pixels that more than one face covers. Samples 40 pixels per
// face.
double overlapping_share(const Chart& chart);

}  // namespace vitrine::inline codec
