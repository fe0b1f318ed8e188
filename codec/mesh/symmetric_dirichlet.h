// SPDX-License-Identifier: Apache-2.0
// The symmetric Dirichlet energy [SS15] of the triangles around one point of a flat picture, as a
// function of that point. The energy is least if all triangles keep their shape and have the same
// scale as their neighbourhood. It is infinite if a triangle is flipped.
//
// The decoder uses this energy, so every machine must compute the same bits (exact_math.h).
#pragma once

#include <span>

#include "codec/core/vec.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// Returns twice the area of the triangle (0, a, b) in space. Long thin triangles count as if they
// were a little wider, so that the cotangents of their corners stay bounded.
double doubled_area(const Vec3& a, const Vec3& b);

// The shape of a triangle (0, a, b) in space.
struct TriangleShape {
  TriangleShape(const Vec3& a, const Vec3& b);

  double area;                 // result of doubled_area()
  double cot_a, cot_b, cot_0;  // halved cotangents of the corners
};

// A triangle (u, a, b), where u is the point that moves. Its corners run counter-clockwise.
class EnergyTriangle {
 public:
  // `shape` is the shape of the triangle in space.
  EnergyTriangle(const Vec2& a, const Vec2& b, const TriangleShape& shape)
      : a_(a), b_(b), shape_(shape), constant_(shape.cot_0 * dot(b - a, b - a)) {}

  // Returns twice the area in the picture.
  double area(const Vec2& u) const { return cross(a_ - u, b_ - u); }
  double area_in_space() const { return shape_.area; }

  struct Derivatives {
    double energy = 0;
    Vec2 gradient;
    double xx = 0, xy = 0, yy = 0;  // second derivatives
  };
  // `scale` is the desired ratio of area in the picture to area in space.
  double energy(const Vec2& u, double scale) const;
  void add_derivatives(const Vec2& u, double scale, Derivatives& sum) const;

  // Returns the part of the energy that grows with the triangle's size in the picture.
  double dirichlet(const Vec2& u) const {
    const Vec2 to_a = a_ - u, to_b = b_ - u;
    return shape_.cot_a * dot(to_b, to_b) + shape_.cot_b * dot(to_a, to_a) + constant_;
  }

 private:
  Vec2 a_, b_;
  TriangleShape shape_;
  double constant_;  // the part of the Dirichlet energy that does not depend on u
};

// Returns the ratio of the area of `star` in the picture to its area in space. Returns 0 if a
// triangle is flipped.
double area_ratio(const Vec2& u, std::span<const EnergyTriangle> star);

// Returns an improved position for the point u in the middle of `star`. Takes one Newton step and
// shortens it until it lowers the energy. Returns u itself if no step lowers the energy or a
// triangle is flipped.
Vec2 relaxed(const Vec2& u, double scale, std::span<const EnergyTriangle> star);

}  // namespace vitrine::inline codec
