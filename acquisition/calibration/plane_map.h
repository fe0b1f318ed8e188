// SPDX-License-Identifier: Apache-2.0
// From image to laser plane: one polynomial a coordinate, which takes projection and distortion of
// the lens at once (paper, eq. 1's world plane).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine {

struct PlanePoint {
  double x = 0, y = 0;  // mm, in the laser plane; y roughly along the table's axis, upwards
};

struct Correspondence {
  double u = 0, v = 0;  // pixels of the region
  PlanePoint at;
  int pose = 0;  // points of one picture of the target hang together
};

class PlaneMap {
 public:
  static constexpr int kLeastDegree = 2, kMostDegree = 5;

  // Least squares over all points, coordinates normalised to [-1, 1] over their box; `degree` 2 to
  // 5. Fails (kBadInput) with points outside the image, with too few, or where they cover too
  // little of it to determine the polynomial.
  static Expected<PlaneMap> fit(std::span<const Correspondence> points, int degree, int width,
                                int height);

  // Nothing outside the convex hull of the points it was fitted to.
  std::optional<PlanePoint> at(double u, double v) const;

  int degree() const { return degree_; }
  // Of the fit's normalised equations: the largest singular value over the least.
  double condition() const { return condition_; }
  // u, v of its corners, counter-clockwise in (u, v).
  std::span<const double> hull() const { return hull_; }
  // Of an image of that size, the part within the hull.
  double image_share(int width, int height) const;

 private:
  friend struct PlaneMapJson;  // keeps it in a file

  struct Terms {
    double x, y;
  };
  struct Interval {  // [centre - half, centre + half] is [-1, 1]
    double centre = 0, half = 1;
    double normalised(double value) const { return (value - centre) / half; }
  };

  bool is_inside(double u, double v) const;
  PlanePoint evaluate(double u, double v) const;

  int degree_ = 3;
  double condition_ = 0;
  Interval u_, v_;
  // (degree + 1)(degree + 2) / 2 coefficients: descending powers of v, and in each those of u.
  std::vector<Terms> terms_;
  std::vector<double> hull_;
};

}  // namespace vitrine
