// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/light.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr int kFirst = -8,
              kColumns = kSensorWidth + 16;  // includes the margin that the blur reads

}  // namespace

PixelRays::PixelRays(const Lens& lens) {
  slopes_.reserve(static_cast<std::size_t>(kColumns) * kSensorHeight * 2);
  for (int v = 0; v < kSensorHeight; ++v) {
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 d = ray(lens, {static_cast<double>(column + kFirst), static_cast<double>(v)});
      const double depth = dot(d, lens.forward);
      slopes_.push_back(static_cast<float>(dot(d, lens.right) / depth));
      slopes_.push_back(static_cast<float>(dot(d, lens.down) / depth));
    }
  }
}

Vec3 PixelRays::direction(const Lens& lens, double u, int v) const {
  const double from_first = u - kFirst;
  const int column = static_cast<int>(from_first);
  const double t = from_first - column;
  const float* at = slopes_.data() + (static_cast<std::ptrdiff_t>(v) * kColumns + column) * 2;
  const double x = at[0] + t * (at[2] - at[0]), y = at[1] + t * (at[3] - at[1]);
  const Vec3 d = lens.forward + lens.right * x + lens.down * y;
  return d * (1 / length(d));
}

}  // namespace vitrine::acquisition::rig
