// SPDX-License-Identifier: Apache-2.0
#include "codec/render/framing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/render/unit_vector.h"

namespace vitrine::inline codec {

ViewAxes::ViewAxes(const Vec3& toward)
    : toward_(unit_vector(toward)),
      right_(unit_vector(cross({0, 1, 0}, toward_))),
      up_(cross(toward_, right_)) {}

Framing frame_around(const TriangleMesh& mesh, std::uint32_t longest, const Vec3& toward) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kMargin = 0.03;
  const ViewAxes axes(toward);
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = low * -1;
  for (const Vec3& position : mesh.positions) {
    const Vec3 p = axes.to_view(position);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low;
  const double longer = std::max(size.x, size.y);
  if (!(longer > 0)) return {.centre = {}, .pixel = 1, .width = longest, .height = longest};
  const auto pixels = [&](double side) {
    return static_cast<std::uint32_t>(std::lround(longest * std::max(0.5, side / longer)));
  };
  return {.centre = axes.to_model((low + high) * 0.5),
          .pixel = longer * (1 + 2 * kMargin) / longest,
          .width = pixels(size.x),
          .height = pixels(size.y),
          .toward = toward};
}

}  // namespace vitrine::inline codec
