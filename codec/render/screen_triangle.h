// SPDX-License-Identifier: Apache-2.0
// A triangle projected to a picture.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Barycentric coordinates: the weights of the three corners at a point. They add up to 1.
struct Barycentric {
  double u, v, w;

  bool is_inside() const { return !(u < 0 || v < 0 || w < 0); }
};

inline Vec3 mix(const std::array<Vec3, 3>& corners, const Barycentric& at) {
  return corners[0] * at.u + corners[1] * at.v + corners[2] * at.w;
}

// A triangle whose corners are given in units of samples. x points right and y down, both from the
// picture's top left corner. z points towards the eye.
class ScreenTriangle {
 public:
  struct Range {
    std::uint32_t first, end;
  };

  explicit ScreenTriangle(const std::array<Vec3, 3>& corners)
      : corners_(corners), area_(area(corners[0], corners[1], corners[2])) {}

  const std::array<Vec3, 3>& corners() const { return corners_; }
  // Twice the triangle's area in the picture. Negative if the corners run counter-clockwise.
  double signed_area() const { return area_; }
  // Whether the triangle's outer side faces the eye.
  bool is_front() const { return area_ < 0; }

  // Returns the corner weights at the centre of a sample. The area must not be 0.
  Barycentric at(std::uint32_t x, std::uint32_t y) const {
    const Vec3 p{x + 0.5, y + 0.5, 0};
    const double u = area(p, corners_[1], corners_[2]) / area_;
    const double v = area(corners_[0], p, corners_[2]) / area_;
    return {u, v, 1 - u - v};
  }

  // Returns the range of samples whose centres may lie in the triangle, along one axis that has
  // `size` samples.
  Range columns(std::uint32_t size) const {
    return range(corners_[0].x, corners_[1].x, corners_[2].x, size);
  }
  Range rows(std::uint32_t size) const {
    return range(corners_[0].y, corners_[1].y, corners_[2].y, size);
  }

 private:
  static double area(const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  static Range range(double a, double b, double c, std::uint32_t size) {
    const auto inside = [&](double t) {
      return static_cast<std::uint32_t>(std::clamp(t, 0.0, static_cast<double>(size)));
    };
    return {inside(std::ceil(std::min({a, b, c}) - 0.5)),
            inside(std::floor(std::max({a, b, c}) - 0.5) + 1)};
  }

  std::array<Vec3, 3> corners_;
  double area_;
};

}  // namespace vitrine::inline codec
