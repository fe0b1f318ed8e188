// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/lens.h"

#include <cmath>

namespace vitrine::acquisition::rig {
namespace {

Vec3 unit(const Vec3& v) {
  return v * (1 / length(v));
}

// Applies the lens distortion to a point of the plane at distance 1 in front of the lens.
ImagePoint distorted(const Lens& lens, double x, double y) {
  const double r2 = x * x + y * y, radial = 1 + r2 * (lens.k1 + r2 * lens.k2);
  return {x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
          y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y};
}

}  // namespace

void aim(Lens& lens, const Vec3& at, const Vec3& target, double roll) {
  lens.at = at;
  lens.forward = unit(target - at);
  const Vec3 right = unit(cross(lens.forward, {0, 0, 1})), down = cross(lens.forward, right);
  lens.right = right * std::cos(roll) + down * std::sin(roll);
  lens.down = down * std::cos(roll) - right * std::sin(roll);
}

std::optional<ImagePoint> project(const Lens& lens, const Vec3& point) {
  const Vec3 d = point - lens.at;
  const double depth = dot(d, lens.forward);
  if (depth <= 0) return std::nullopt;
  const ImagePoint p = distorted(lens, dot(d, lens.right) / depth, dot(d, lens.down) / depth);
  return ImagePoint{lens.centre.u + lens.focal * p.u, lens.centre.v + lens.focal * p.v};
}

Vec3 ray(const Lens& lens, const ImagePoint& pixel) {
  const double u = (pixel.u - lens.centre.u) / lens.focal;
  const double v = (pixel.v - lens.centre.v) / lens.focal;
  double x = u, y = v;
  for (int round = 0; round < 10; ++round) {  // each round reduces the error by a factor of 50
    const ImagePoint p = distorted(lens, x, y);
    x += u - p.u;
    y += v - p.v;
  }
  return unit(lens.right * x + lens.down * y + lens.forward);
}

}  // namespace vitrine::acquisition::rig
