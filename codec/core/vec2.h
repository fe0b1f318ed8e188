// SPDX-License-Identifier: Apache-2.0
// Vectors with two components: doubles and 32-bit integers for texture coordinates.
#pragma once

#include <compare>
#include <cstdint>

namespace vitrine::inline codec {

struct Vec2 {
  double x = 0, y = 0;

  constexpr Vec2 operator+(const Vec2& o) const { return {x + o.x, y + o.y}; }
  constexpr Vec2 operator-(const Vec2& o) const { return {x - o.x, y - o.y}; }
  constexpr Vec2 operator*(double s) const { return {x * s, y * s}; }
  constexpr bool operator==(const Vec2&) const = default;
};

constexpr double dot(const Vec2& a, const Vec2& b) {
  return a.x * b.x + a.y * b.y;
}
// Returns twice the signed area of the triangle (0, a, b): positive if 0, a and b are in
// counter-clockwise order.
constexpr double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

struct Vec2i {
  std::int32_t x = 0, y = 0;

  constexpr Vec2i operator+(const Vec2i& o) const { return {x + o.x, y + o.y}; }
  constexpr Vec2i operator-(const Vec2i& o) const { return {x - o.x, y - o.y}; }
  constexpr auto operator<=>(const Vec2i&) const = default;
};

constexpr Vec2 to_vec2(const Vec2i& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

}  // namespace vitrine::inline codec
