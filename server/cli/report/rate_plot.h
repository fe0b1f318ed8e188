// SPDX-License-Identifier: Apache-2.0
// Draws a plot of error against bytes as SVG.
#pragma once

#include <string>
#include <vector>

namespace vitrine::server {

struct RatePoint {
  double bytes = 0;  // bytes to send to reach this error
  double error = 0;  // error in % of the diagonal; 0 cannot be drawn on a logarithmic scale
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
