// SPDX-License-Identifier: Apache-2.0
#include "codec/format/placement.h"

namespace vitrine::inline codec {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {  // requires b > 0
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

struct Sum {
  std::int64_t x = 0, y = 0, z = 0;
};

Sum sum_of(std::span<const Vec3i> points) {
  Sum s;
  for (const Vec3i& p : points)
    s.x += p.x, s.y += p.y, s.z += p.z;
  return s;
}

}  // namespace

Vec3i pyramid_term(std::span<const Vec3i> opposite, std::span<const Vec3i> others,
                   std::int32_t parity) {
  if (opposite.empty() || others.empty()) return midpoint_term(parity);
  const Sum near = sum_of(opposite), far = sum_of(others);
  const auto m = static_cast<std::int64_t>(opposite.size());
  const auto n = static_cast<std::int64_t>(others.size());
  const std::int64_t den = 2 * m * n;
  const auto term = [&](std::int64_t a, std::int64_t b) {
    return static_cast<std::int32_t>(floor_divide(2 * (n * a - m * b) + den, 2 * den)) + parity;
  };
  return {term(near.x, far.x), term(near.y, far.y), term(near.z, far.z)};
}

}  // namespace vitrine::inline codec
