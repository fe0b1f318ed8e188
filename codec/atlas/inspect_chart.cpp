// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/inspect_chart.h"

#include <algorithm>
#include <cmath>

#include "codec/atlas/chart_areas.h"
#include "codec/core/exact_math.h"

namespace vitrine::inline codec {
namespace {

constexpr double kLeastAreaRatio = 1.0 / 8, kMostAreaRatio = 6;
constexpr double kMostOverlap = 0.002;
constexpr double kPixelsPerFace = 40;
constexpr double kMostPixelsPerFace = 4000;  // limit on the pixels of the chart's bounding box

// Calls row(y, begin, end) for the pixels whose centres lie in a triangle. Two triangles with a
// common side share no pixel.
template <class Row>
void sample(const std::array<Vec2, 3>& t, const Row& row) {
  const double low = std::min({t[0].y, t[1].y, t[2].y}), high = std::max({t[0].y, t[1].y, t[2].y});
  for (std::int32_t y = exact::floor(low + 0.5); y + 0.5 < high; ++y) {
    double first = 1e300, last = -1e300;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &p = t[k], &q = t[k == 2 ? 0 : k + 1];
      const Vec2 &a = p.y < q.y ? p : q, &b = p.y < q.y ? q : p;
      if (a.y > y + 0.5 || b.y <= y + 0.5) continue;
      const double x = a.x + (b.x - a.x) * ((y + 0.5 - a.y) / (b.y - a.y));
      first = std::min(first, x), last = std::max(last, x);
    }
    if (first < last) row(y, exact::floor(first + 0.5), exact::floor(last + 0.5));
  }
}

struct PixelGrid {
  Vec2 low;
  double per_unit;
  std::int32_t width, height;
};

PixelGrid grid_of(const Chart& chart) {
  Vec2 low = chart.uv[0], high = chart.uv[0];
  for (const Vec2& p : chart.uv) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  double area = 0;
  for (std::uint32_t f = 0; f < chart.size(); ++f)
    area += std::abs(area_in_plane(chart, f));
  const Vec2 side = high - low;
  const double side_sum = side.x + side.y > 0 ? side.x + side.y : 1;
  const double pixels = kPixelsPerFace * chart.size(), most = kMostPixelsPerFace * chart.size();
  double per_unit = std::sqrt(std::min(pixels / area, most / (side_sum * side_sum)));
  if (!(area > 0)) per_unit = 1 / side_sum;
  return {low, per_unit, exact::floor(side.x * per_unit) + 2, exact::floor(side.y * per_unit) + 2};
}

bool is_bad(const Chart& chart, std::uint32_t f) {
  const double plane = area_in_plane(chart, f), space = area_in_space(chart, f);
  return !(plane > space * kLeastAreaRatio && plane < space * kMostAreaRatio);
}

}  // namespace

double overlapping_share(const Chart& chart) {
  const PixelGrid grid = grid_of(chart);
  std::vector<std::uint8_t> count(static_cast<std::size_t>(grid.width) * grid.height, 0);
  for (const Triangle& w : chart.wedges) {
    std::array<Vec2, 3> t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = (chart.uv[w[k]] - grid.low) * grid.per_unit;
    sample(t, [&](std::int32_t y, std::int32_t begin, std::int32_t end) {
      for (std::int32_t x = begin; x < end; ++x) {
        std::uint8_t& n = count[static_cast<std::size_t>(y) * grid.width + x];
        if (n < 2) ++n;
      }
    });
  }
  const auto twice = static_cast<double>(std::count(count.begin(), count.end(), 2));
  const auto once = static_cast<double>(std::count(count.begin(), count.end(), 1));
  return twice > 0 ? twice / (once + twice) : 0;
}

ChartFaults inspect(const Chart& chart) {
  ChartFaults faults{.overlaps = overlapping_share(chart) > kMostOverlap, .bad_faces = {}};
  for (std::uint32_t f = 0; f < chart.size(); ++f) {
    if (is_bad(chart, f)) faults.bad_faces.push_back(f);
  }
  return faults;
}

}  // namespace vitrine::inline codec
