// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/symmetric_dirichlet.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrine::inline codec {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double energy_of(const Vec2& u, double scale, std::span<const EnergyTriangle> star) {
  double sum = 0;
  for (const EnergyTriangle& t : star)
    sum += t.energy(u, scale);
  return sum;
}

// Returns the Newton step for these derivatives. If they show that the energy is not convex,
// returns a step down the gradient.
Vec2 newton_step(const EnergyTriangle::Derivatives& d) {
  const double det = d.xx * d.yy - d.xy * d.xy;
  if (d.xx > 0 && det > 1e-3 * d.xx * d.yy) {
    return Vec2{d.xy * d.gradient.y - d.yy * d.gradient.x,
                d.xy * d.gradient.x - d.xx * d.gradient.y} *
           (1 / det);
  }
  const double bound = std::max(std::abs(d.xx), std::abs(d.yy)) + std::abs(d.xy);
  return bound > 0 ? d.gradient * (-1 / bound) : Vec2{};
}

}  // namespace

double doubled_area(const Vec3& a, const Vec3& b) {
  const Vec3 across = b - a;
  const double longest = std::max({dot(a, a), dot(b, b), dot(across, across)});
  return std::max(length(cross(a, b)), 0.01 * longest);
}

TriangleShape::TriangleShape(const Vec3& a, const Vec3& b) : area(doubled_area(a, b)) {
  const Vec3 across = b - a;
  const double half = area > 0 ? 0.5 / area : 0;
  cot_a = -dot(a, across) * half;
  cot_b = dot(b, across) * half;
  cot_0 = dot(a, b) * half;
}

double EnergyTriangle::energy(const Vec2& u, double scale) const {
  const double now = area(u);
  if (!(now > 0)) return kInfinite;
  const double ratio = scale * shape_.area / now;
  return dirichlet(u) * (1 + ratio * ratio);
}

void EnergyTriangle::add_derivatives(const Vec2& u, double scale, Derivatives& sum) const {
  const double now = area(u);
  const double ratio = scale * shape_.area / now, inverse = ratio * ratio, d = dirichlet(u);
  const Vec2 of_area = {a_.y - b_.y, b_.x - a_.x};
  const Vec2 of_d = ((u - b_) * shape_.cot_a + (u - a_) * shape_.cot_b) * 2;
  const double first = -2 * inverse / now, second = 6 * inverse / (now * now);
  const double bend = 2 * (shape_.cot_a + shape_.cot_b) * (1 + inverse);
  sum.energy += d * (1 + inverse);
  sum.gradient = sum.gradient + of_d * (1 + inverse) + of_area * (d * first);
  sum.xx += bend + 2 * first * of_d.x * of_area.x + d * second * of_area.x * of_area.x;
  sum.xy += first * (of_d.x * of_area.y + of_d.y * of_area.x) + d * second * of_area.x * of_area.y;
  sum.yy += bend + 2 * first * of_d.y * of_area.y + d * second * of_area.y * of_area.y;
}

double area_ratio(const Vec2& u, std::span<const EnergyTriangle> star) {
  double in_picture = 0, in_space = 0;
  for (const EnergyTriangle& t : star) {
    if (!(t.area(u) > 0)) return 0;
    in_picture += t.area(u);
    in_space += t.area_in_space();
  }
  return in_space > 0 ? in_picture / in_space : 0;
}

Vec2 relaxed(const Vec2& u, double scale, std::span<const EnergyTriangle> star) {
  for (const EnergyTriangle& t : star) {
    if (!(t.area(u) > 0)) return u;
  }
  EnergyTriangle::Derivatives now;
  for (const EnergyTriangle& t : star)
    t.add_derivatives(u, scale, now);
  const Vec2 step = newton_step(now);
  double share = 1;
  for (int trial = 0; trial < 4; ++trial, share *= 0.4) {
    const Vec2 to = u + step * share;
    if (energy_of(to, scale, star) < now.energy) return to;
  }
  return u;
}

}  // namespace vitrine::inline codec
