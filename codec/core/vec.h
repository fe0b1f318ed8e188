// SPDX-License-Identifier: Apache-2.0
// Vectors with three components: doubles for model space, 32-bit integers for lattice space.
#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>

namespace vitrine::inline codec {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr Vec3 operator+(const Vec3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  constexpr Vec3 operator-(const Vec3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  constexpr Vec3 operator*(double s) const { return {x * s, y * s, z * s}; }
  constexpr Vec3& operator+=(const Vec3& o) { return *this = *this + o; }
  constexpr Vec3& operator-=(const Vec3& o) { return *this = *this - o; }
  constexpr bool operator==(const Vec3&) const = default;
};

constexpr double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

struct Vec3i {
  std::int32_t x = 0, y = 0, z = 0;

  constexpr Vec3i operator+(const Vec3i& o) const { return {x + o.x, y + o.y, z + o.z}; }
  constexpr Vec3i operator-(const Vec3i& o) const { return {x - o.x, y - o.y, z - o.z}; }
  // lexicographic order: x, then y, then z
  constexpr auto operator<=>(const Vec3i&) const = default;
};

constexpr Vec3 to_vec3(const Vec3i& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

using Triangle = std::array<std::uint32_t, 3>;
using Colour = std::array<std::uint8_t, 3>;  // sRGB-coded red, green and blue

}  // namespace vitrine::inline codec
