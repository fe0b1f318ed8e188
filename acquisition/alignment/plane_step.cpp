// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/plane_step.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

using Vector6 = std::array<double, 6>;
// A pivot smaller than this multiple of the largest diagonal entry is regarded as a rounding error.
constexpr double kDetermined = 1e-9;

// Solves a positive semidefinite system by Gaussian elimination. Returns zero if the system is
// singular.
Vector6 solve(std::array<Vector6, 6> a, Vector6 b) {
  double largest = 0;
  for (std::size_t k = 0; k < 6; ++k)
    largest = std::max(largest, a[k][k]);
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(a[k][k] > kDetermined * largest)) return {};
    for (std::size_t i = k + 1; i < 6; ++i) {
      const double share = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 6; ++j)
        a[i][j] -= share * a[k][j];
      b[i] -= share * b[k];
    }
  }
  Vector6 x{};
  for (std::size_t k = 6; k-- > 0;) {
    double rest = b[k];
    for (std::size_t j = k + 1; j < 6; ++j)
      rest -= a[k][j] * x[j];
    x[k] = rest / a[k][k];
  }
  return x;
}

// Rotates `p` about the vector `turn` by the angle |turn|, in radians (Rodrigues' formula).
Vec3 rotated(const Vec3& p, const Vec3& turn) {
  const double angle = length(turn);
  if (!(angle > 0)) return p;
  const Vec3 axis = turn * (1 / angle);
  return p * std::cos(angle) + cross(axis, p) * std::sin(angle) +
         axis * (dot(axis, p) * (1 - std::cos(angle)));
}

RigidMotion rotation_of(const Vec3& turn) {
  const Vec3 x = rotated({1, 0, 0}, turn), y = rotated({0, 1, 0}, turn),
             z = rotated({0, 0, 1}, turn);
  return {{Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}}, {}};
}

}  // namespace

RigidMotion towards_planes(std::span<const Counterpart> pairs) {
  Vec3 middle;
  for (const Counterpart& pair : pairs)
    middle += pair.point * (1 / static_cast<double>(pairs.size()));
  std::array<Vector6, 6> a{};
  Vector6 b{};
  for (const Counterpart& pair : pairs) {
    const Vec3 n = pair.normal, turn = cross(pair.point - middle, n);
    const Vector6 row = {turn.x, turn.y, turn.z, n.x, n.y, n.z};
    const double distance = dot(pair.on - pair.point, n);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j)
        a[i][j] += row[i] * row[j];
      b[i] += row[i] * distance;
    }
  }
  const Vector6 x = solve(a, b);
  RigidMotion step = rotation_of({x[0], x[1], x[2]});
  step.shift = middle - step(middle) + Vec3{x[3], x[4], x[5]};
  return step;
}

}  // namespace vitrine::acquisition
