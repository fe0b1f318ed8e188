// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace vitrine {

struct RatePoint {
  double bytes = 0;  // that have to be sent
  double error = 0;  // in % of the diagonal; those of 0 have no place on a logarithmic scale
};

struct RateSeries {
  std::string style;  // class of the group in the drawing
  std::string label;  // plain text
  std::vector<RatePoint> points;
};

// An <svg> with both axes logarithmic; each series is a line with a mark per point. Its colours are
// those of the page's style. Empty where fewer than two points can be drawn.
std::string rate_plot(const std::vector<RateSeries>& series);

}  // namespace vitrine
