// SPDX-License-Identifier: Apache-2.0
// A bounding box whose axes follow the triangles in it. It bounds neighbouring long triangles far
// more closely than a box along the coordinate axes does.
#pragma once

#include <array>
#include <limits>

#include "codec/core/vec.h"
#include "codec/mesh/closest_point.h"

namespace vitrine::inline codec {

class OrientedBox {
 public:
  OrientedBox() = default;
  // Creates an empty box. Its axes are the triangle's longest edge, the direction perpendicular to
  // this edge in the triangle's plane, and the normal. If the triangle has no area, chooses
  // arbitrary directions for the axes that it does not determine.
  explicit OrientedBox(const TrianglePoints& triangle);

  // Extends the box to contain p.
  void add(const Vec3& p);

  // Returns a lower bound of the squared distance from p to all points within `slack` of the box.
  double squared_distance(const Vec3& p, double slack) const;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::array<Vec3, 3> axis_;  // perpendicular unit vectors
  // Extent along each axis in model units, widened by rounding errors.
  std::array<double, 3> low_ = {kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high_ = {-kInfinity, -kInfinity, -kInfinity};
};

}  // namespace vitrine::inline codec
