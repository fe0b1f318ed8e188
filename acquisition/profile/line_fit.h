// SPDX-License-Identifier: Apache-2.0
// Fits a line to points by least squares. The fit keeps only running sums, so points can be added
// and fits merged.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vitrine::acquisition {

class LineFit {
 public:
  void add(double x, double y) {
    n_ += 1, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y, yy_ += y * y;
  }
  LineFit operator+(const LineFit& o) const {
    LineFit both = *this;
    both.n_ += o.n_, both.x_ += o.x_, both.y_ += o.y_;
    both.xx_ += o.xx_, both.xy_ += o.xy_, both.yy_ += o.yy_;
    return both;
  }

  double count() const { return n_; }
  double slope() const {
    const double spread = xx_ - x_ * x_ / n_;
    return spread > 0 ? (xy_ - x_ * y_ / n_) / spread : 0;
  }
  double at(double x) const { return y_ / n_ + slope() * (x - x_ / n_); }
  // Returns the sum of squared distances between points and line, measured along y.
  double squares() const {
    return std::max(0., yy_ - y_ * y_ / n_ - slope() * (xy_ - x_ * y_ / n_));
  }
  // Returns the smallest possible sum of squared perpendicular distances between the points and a
  // line: the smaller eigenvalue of the scatter matrix.
  double squares_across() const {
    const auto [a, b, c] = scatter();
    return std::max(0., (a + c) / 2 - std::hypot((a - c) / 2, b));
  }
  // Projects (x, y) onto the line with the least sum of squared perpendicular distances.
  std::pair<double, double> onto(double x, double y) const {
    const auto [a, b, c] = scatter();
    const double turn = std::atan2(2 * b, a - c) / 2, along_x = std::cos(turn),
                 along_y = std::sin(turn);
    const double along = (x - x_ / n_) * along_x + (y - y_ / n_) * along_y;
    return {x_ / n_ + along * along_x, y_ / n_ + along * along_y};
  }
  // Returns whether one line fits all points, which must be three or more: squares() must not
  // exceed a limit. If the points deviate only by noise of standard deviation `noise`, squares()
  // stays below the limit in about 95 % of all cases.
  bool is_within(double noise) const {
    if (n_ < 3) return false;
    return squares() <= noise * noise * (n_ - 2) * (1 + 2.5 / std::sqrt(n_ - 2));
  }

 private:
  std::array<double, 3> scatter() const {
    return {xx_ - x_ * x_ / n_, xy_ - x_ * y_ / n_, yy_ - y_ * y_ / n_};
  }

  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace vitrine::acquisition
