// SPDX-License-Identifier: Apache-2.0
// Computes areas of a chart's faces, in space and in the plane.
#pragma once

#include "codec/atlas/chart.h"
#include "codec/mesh/symmetric_dirichlet.h"

namespace vitrine::inline codec {

// Returns the area of the face in space. Very thin faces count as slightly wider than they are
// (doubled_area()).
inline double area_in_space(const Chart& chart, std::uint32_t face) {
  const auto& [a, b, c] = chart.wedges[face];
  const Vec3& from = chart.positions[a];
  return doubled_area(chart.positions[b] - from, chart.positions[c] - from) / 2;
}

// Returns the area of the face in the plane. The area is negative if the face is flipped.
inline double area_in_plane(const Chart& chart, std::uint32_t face) {
  const auto& [a, b, c] = chart.wedges[face];
  return cross(chart.uv[b] - chart.uv[a], chart.uv[c] - chart.uv[a]) / 2;
}

}  // namespace vitrine::inline codec
