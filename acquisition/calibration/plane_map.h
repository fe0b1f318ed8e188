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
  // Least squares over all points, coordinates normalised to [-1, 1]; `degree` 2 to 5. Fails
  // (kBadInput) with too few points or where they cover too little of the image to determine the
  // polynomial.
  static Expected<PlaneMap> fit(std::span<const Correspondence> points, int degree, int width,
                                int height);

  // Nothing outside the convex hull of the points it was fitted to.
  std::optional<PlanePoint> at(double u, double v) const;

  int degree() const { return degree_; }

 private:
  friend struct PlaneMapJson;  // keeps it in a file

  int degree_ = 3, width_ = 0, height_ = 0;
  std::vector<double> x_, y_;  // coefficients, (degree + 1)(degree + 2) / 2 each
  std::vector<double> hull_;   // u, v of its corners, counter-clockwise in (u, v)
};

}  // namespace vitrine
