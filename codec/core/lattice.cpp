// SPDX-License-Identifier: Apache-2.0
#include "codec/core/lattice.h"

#include <algorithm>

#include "codec/core/bounds.h"

namespace vitrine::inline codec {
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
  const Bounds box = bounds_of(positions);
  const double step = box.longest_side() / static_cast<double>((1 << bits) - 1);
  return {.origin = box.low, .step = step > 0 ? step : 1.0, .bits = bits};
}

}  // namespace vitrine::inline codec
