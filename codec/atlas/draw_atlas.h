// SPDX-License-Identifier: Apache-2.0
// Draws an atlas on a mesh: cuts the surface into charts and flattens each chart. Every machine
// computes the same bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Texture coordinates of a mesh, one pair per wedge. A wedge is a set of corners of one vertex
// within one chart, joined across edges without seams.
struct Atlas {
  std::vector<std::array<std::uint32_t, 3>> wedges;  // for each face, the wedges of its corners
  // Coordinates of each wedge, in the unit of the positions. Each chart has its final size and
  // orientation, but not its final place, which pack() finds.
  std::vector<std::array<double, 2>> uv;
  std::vector<std::uint32_t> chart;  // chart of each wedge, in [0, charts)
  std::uint32_t charts = 0;
};

// Draws an atlas of `faces`, which index `positions`. The mesh should be a manifold of at most
// about 10,000 faces; boundaries, handles and many components are allowed. Edges with more than two
// faces become seams. Each chart is connected and has the area of its faces in space.
//
// In the plane, the corners of every face run counter-clockwise. A chart overlaps itself by at most
// 0.2 % of its area.
Atlas draw_atlas(std::span<const Vec3> positions, std::span<const Triangle> faces);

}  // namespace vitrine::inline codec
