// SPDX-License-Identifier: Apache-2.0
// Draws a plot of error against bytes as SVG.
#pragma once

#include <string>
#include <vector>

namespace vitrine::server {

struct RatePoint {
  double bytes = 0;  // bytes to send to reach this error
  // Error in % of the bounding box's diagonal. A point with error 0 is left out, since it has no
  // place on a logarithmic axis.
  double error = 0;
};

struct RateSeries {
  std::string style;  // CSS class of the series' group in the drawing
  std::string label;  // text of the legend, not escaped
  std::vector<RatePoint> points;
};

// Returns an <svg> with two logarithmic axes. Each series is a line with a mark at each point. The
// page's style sets the colours. Returns an empty text if fewer than two points can be drawn.
std::string rate_plot(const std::vector<RateSeries>& series);

}  // namespace vitrine::server
