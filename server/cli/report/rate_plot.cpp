// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/rate_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/cli/report/markup.h"

namespace vitrine::server {
namespace {

constexpr double kWidth = 880, kHeight = 440;
constexpr double kLeft = 62, kRight = 16, kTop = 34, kBottom = 46;

// A logarithmic axis that maps values from `low` to `high` to pixels from `first` to `last`.
class LogarithmicAxis {
 public:
  LogarithmicAxis(double low, double high, double first, double last)
      : low_(std::log10(low)), high_(std::log10(high)), first_(first), last_(last) {
    const double air = std::max(0.02, 0.04 * (high_ - low_));
    low_ -= air, high_ += air;
  }

  double at(double value) const {
    return first_ + (std::log10(value) - low_) / (high_ - low_) * (last_ - first_);
  }

  // Returns the ticks 1, 10, 100 … within the range, or 1, 2, 5, 10 … if there would be fewer than
  // three.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    const bool is_sparse = std::floor(high_) - std::ceil(low_) < 2;
    for (double decade = std::floor(low_); decade <= high_; ++decade) {
      for (const int step : {1, 2, 5}) {
        const double value = step * std::pow(10, decade);
        const bool is_inside = std::log10(value) >= low_ && std::log10(value) <= high_;
        if (is_inside && (is_sparse || step == 1)) ticks.push_back(value);
      }
    }
    return ticks;
  }

 private:
  double low_, high_, first_, last_;
};

struct Axes {
  LogarithmicAxis x, y;
};

// Formats a tick with only the digits that it needs, such as 0.001, 0.02, 1 or 10.
std::string tick_text(double value) {
  const int decimals = -static_cast<int>(std::floor(std::log10(value * 1.0005)));
  return fmt::format("{:.{}f}", value, std::max(0, decimals));
}

std::string byte_tick(double bytes) {
  if (bytes < 999)
    return tick_text(bytes) +
           "\xC2\xA0"
           "B";
  if (bytes < 999e3) return tick_text(bytes / 1e3) + "\xC2\xA0kB";
  return bytes < 999e6 ? tick_text(bytes / 1e6) + "\xC2\xA0MB"
                       : tick_text(bytes / 1e9) + "\xC2\xA0GB";
}

std::string grid(const Axes& axes) {
  std::string out = "<g class=\"grid\">";
  for (const double bytes : axes.x.ticks()) {
    out += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        axes.x.at(bytes), kTop, kHeight - kBottom, kHeight - kBottom + 18, byte_tick(bytes));
  }
  for (const double error : axes.y.ticks()) {
    out += fmt::format(
        "<line x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>",
        axes.y.at(error), kLeft, kWidth - kRight, kLeft - 8, axes.y.at(error) + 4,
        tick_text(error));
  }
  return out + fmt::format(
                   "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">bytes sent</text>"
                   "<text x=\"0\" y=\"{}\">error, % of the diagonal</text></g>",
                   kWidth - kRight, kHeight - 6, 14);
}

std::vector<RatePoint> drawable(const RateSeries& series) {
  std::vector<RatePoint> points = series.points;
  std::erase_if(points, [](const RatePoint& p) { return !(p.bytes > 0 && p.error > 0); });
  return points;
}

std::string line(const RateSeries& series, const Axes& axes) {
  std::string path, marks;
  for (const RatePoint& p : drawable(series)) {
    const double x = axes.x.at(p.bytes), y = axes.y.at(p.error);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
    marks += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>{}: {}, {}\xC2\xA0%</title></circle>",
        x, y, escaped(series.label), bytes_text(static_cast<std::uint64_t>(p.bytes)),
        significant(p.error));
  }
  return fmt::format("<g class=\"{}\"><path d=\"{}\"/>{}</g>", series.style, path, marks);
}

// Places the legend at the bottom left, where falling curves leave space.
std::string legend(const std::vector<RateSeries>& series) {
  std::string out;
  double y = kHeight - kBottom - 22.0 * static_cast<double>(series.size());
  for (const RateSeries& s : series) {
    const double x = kLeft + 16;
    out += fmt::format(
        "<g class=\"{0}\"><path d=\"M{1} {2}h34\"/><circle cx=\"{3}\" cy=\"{2}\" r=\"3.5\"/>"
        "<text x=\"{4}\" y=\"{5}\">{6}</text></g>",
        s.style, x, y, x + 17, x + 44, y + 4, escaped(s.label));
    y += 22;
  }
  return out;
}

}  // namespace

std::string rate_plot(const std::vector<RateSeries>& series) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RatePoint low{kInfinity, kInfinity}, high{0, 0};
  std::size_t points = 0;
  for (const RateSeries& s : series) {
    for (const RatePoint& p : drawable(s)) {
      low = {std::min(low.bytes, p.bytes), std::min(low.error, p.error)};
      high = {std::max(high.bytes, p.bytes), std::max(high.error, p.error)};
      ++points;
    }
  }
  if (points < 2) return {};
  const Axes axes{{low.bytes, high.bytes, kLeft, kWidth - kRight},
                  {low.error, high.error, kHeight - kBottom, kTop}};
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Error against bytes\">",
                  kWidth, kHeight);
  out += grid(axes);
  // draws the first series last, so that it is on top
  for (auto s = series.rbegin(); s != series.rend(); ++s)
    out += line(*s, axes);
  return out + legend(series) + "</svg>";
}

}  // namespace vitrine::server
