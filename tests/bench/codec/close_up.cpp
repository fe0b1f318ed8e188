// SPDX-License-Identifier: Apache-2.0
#include "close_up.h"
#include "support/product_names.h"

#include <algorithm>
#include <cmath>

namespace vitrine::bench {
namespace {

constexpr double kFieldOfView = 35;  // vertical, in degrees

View look(const Vec3& at, const Vec3& back, double distance) {
  const Vec3 aside = std::abs(back.y) > 0.5 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 right = cross(aside, back), up = cross(back, right), eye = at + back * distance;
  return {.camera = {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0,
                     eye.x, eye.y, eye.z, 1},
          .field_of_view = kFieldOfView,
          .width = 800,
          .height = 600};
}

}  // namespace

std::vector<View> close_ups(const TriangleMesh& mesh, double share) {
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double slope = std::tan(kFieldOfView * 3.14159265358979323846 / 360);
  const double distance = share * length(high - low) / (2 * slope);
  std::vector<View> views;
  for (const Vec3& back :
       {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const Vec3 at =
        *std::ranges::max_element(mesh.positions, {}, [&](const Vec3& p) { return dot(p, back); });
    views.push_back(look(at, back, distance));
  }
  return views;
}

std::uint64_t bytes_for(const Manifest& manifest, const View& view) {
  Planner planner(manifest);
  planner.want(view);
  while (const auto chunk = planner.next())
    planner.have(*chunk);
  return planner.bytes_held();
}

}  // namespace vitrine::bench
