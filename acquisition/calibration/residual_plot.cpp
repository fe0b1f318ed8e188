// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "acquisition/calibration/report.h"

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kMostArrows = 1500;
// Length, in pixels, of an arrow for a residual at the 95th percentile.
constexpr double kArrow = 40;
constexpr int kHueStep = 137;  // hues of consecutive poses differ by this many degrees

}  // namespace

std::string residual_plot(const Calibration& calibration, const CalibrationReport& report) {
  const int width = calibration.region.width, height = calibration.region.height;
  const ResidualSummary& r = report.residuals;
  const double scale = r.p95 > 0 ? kArrow / r.p95 : 0;
  std::string svg;
  const auto out = std::back_inserter(svg);
  fmt::format_to(out,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" "
                 "font-family=\"sans-serif\" font-size=\"22\">\n"
                 "<rect width=\"{}\" height=\"{}\" fill=\"#fff\" stroke=\"#888\"/>\n<polygon "
                 "fill=\"#eef\" stroke=\"#88a\" points=\"",
                 width, height + 40, width, height);
  const std::span<const double> hull = calibration.map.hull();
  for (std::size_t i = 0; i < hull.size(); i += 2)
    fmt::format_to(out, "{:.1f},{:.1f} ", hull[i], hull[i + 1]);
  svg += "\"/>\n";
  const std::size_t count = report.held_out.size(),
                    step = std::max<std::size_t>(1, (count + kMostArrows - 1) / kMostArrows);
  for (std::size_t i = 0; i < count; i += step) {
    const HeldOutPoint& p = report.held_out[i];
    fmt::format_to(out, "<path stroke=\"hsl({},70%,40%)\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}\"/>\n",
                   p.pose * kHueStep % 360, p.u, p.v, p.dx * scale, -p.dy * scale);
  }
  fmt::format_to(out,
                 "<path stroke=\"#000\" stroke-width=\"3\" d=\"M10 {0}h{1:.1f}\"/><text x=\"{2}\" "
                 "y=\"{3}\">{4:.4f} mm · held-out poses: rms {5:.4f}, p95 {4:.4f}, max {6:.4f} mm"
                 "</text>\n</svg>\n",
                 height + 20, scale * r.p95, 20 + kArrow, height + 27, r.p95, r.rms, r.max);
  return svg;
}

}  // namespace vitrine::acquisition
