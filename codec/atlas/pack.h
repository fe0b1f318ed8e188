// SPDX-License-Identifier: Apache-2.0
// Packs the charts of an atlas into a square.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace vitrine::inline codec {

// Triangles that cover a chart, in the chart's own plane, unit and orientation. Triangles may
// overlap, because they include the triangles of several levels of detail.
using ChartTriangles = std::vector<std::array<std::array<double, 2>, 3>>;

// Point `uv` of chart i moves to uv * scale + offset[i], which lies in the square [0, 1]^2.
struct Packing {
  double scale = 1;
  std::vector<std::array<double, 2>> offset;  // offset of each chart
};

// Places all charts at the same scale, as large as possible and without rotation. Points of
// different charts are at least `gutter` apart, as a fraction of the square's side. Coordinates
// must be finite and below 1e100. A chart without triangles gets an arbitrary place. Tries about
// ten scales; each takes time proportional to the number of triangles.
//
// If there are so many charts that the gutters alone fill the square, the gutter is halved until
// the charts fit.
Packing pack(std::span<const ChartTriangles> charts, double gutter = 1.0 / 256);

}  // namespace vitrine::inline codec
