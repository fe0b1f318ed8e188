// SPDX-License-Identifier: Apache-2.0
// Maps image points to the laser plane by one polynomial for each coordinate. The polynomials
// include the lens distortion. Source: [WLL] eq. 1, image to world plane.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct PlanePoint {
  // Coordinates in the laser plane, in mm. y runs upwards, roughly along the table's axis.
  double x = 0, y = 0;
};

struct Correspondence {
  double u = 0, v = 0;  // in pixels from the region's top left pixel
  PlanePoint at;
  int pose = 0;  // index of the picture that shows the point
};

class PlaneMap {
 public:
  static constexpr int kLeastDegree = 2, kMostDegree = 5;

  // Fits the polynomials by least squares over all points. Coordinates are normalised to [-1, 1]
  // over the points' bounding box. `degree` is 2 to 5. Fails with kBadInput if points lie outside
  // the image, are too few, or cover too little of the image to determine the polynomials.
  static Expected<PlaneMap> fit(std::span<const Correspondence> points, int degree, int width,
                                int height);

  // Maps a pixel to the laser plane. Returns nullopt outside the convex hull of the fitted points.
  std::optional<PlanePoint> at(double u, double v) const;

  int degree() const { return degree_; }
  // Condition number of the normalised equations: the ratio of the largest to the smallest singular
  // value.
  double condition() const { return condition_; }
  // The hull's corners (u, v), counter-clockwise in (u, v).
  std::span<const double> hull() const { return hull_; }
  // Returns the share of an image of that size that lies within the hull.
  double image_share(int width, int height) const;

 private:
  friend struct PlaneMapJson;  // reads and writes the private members

  struct Terms {
    double x, y;
  };
  struct Interval {  // linear map of [centre - half, centre + half] to [-1, 1]
    double centre = 0, half = 1;
    double normalised(double value) const { return (value - centre) / half; }
  };

  bool is_inside(double u, double v) const;
  PlanePoint evaluate(double u, double v) const;

  int degree_ = 3;
  double condition_ = 0;
  Interval u_, v_;
  // (degree + 1)(degree + 2) / 2 coefficients, ordered by descending powers of v, and for equal
  // powers of v by descending powers of u.
  std::vector<Terms> terms_;
  std::vector<double> hull_;
};

}  // namespace vitrine::acquisition
