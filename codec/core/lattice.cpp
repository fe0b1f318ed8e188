// SPDX-License-Identifier: Apache-2.0
#include "codec/core/lattice.h"

#include <algorithm>

namespace vitrine {
namespace {

std::int32_t to_grid(double value, double origin, double step, int bits) {
  const double top = static_cast<double>((1 << bits) - 1);
  return static_cast<std::int32_t>(std::clamp(std::floor((value - origin) / step + 0.5), 0.0, top));
}

}  // namespace

Vec3i Lattice::to_lattice(const Vec3& p) const {
  return {to_grid(p.x, origin.x, step, bits), to_grid(p.y, origin.y, step, bits),
          to_grid(p.z, origin.z, step, bits)};
}

Lattice fit_lattice(std::span<const Vec3> positions, int bits) {
  if (positions.empty()) return {.bits = bits};
  Vec3 low = positions[0], high = positions[0];
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 side = high - low;
  const double longest = std::max({side.x, side.y, side.z});
  const double step = longest / static_cast<double>((1 << bits) - 1);
  return {.origin = low, .step = step > 0 ? step : 1.0, .bits = bits};
}

}  // namespace vitrine
