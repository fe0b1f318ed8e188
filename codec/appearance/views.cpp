// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/views.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace vitrine::inline codec {
namespace {

// Margin in pixels. It leaves room for the SSIM windows [WBSS04] at the sphere's rim.
constexpr double kMargin = 8;

// Calls `visit` with the position of each corner of each face. Skips vertices without faces,
// because they are invisible.
template <class Visit>
void visit_corners(const TriangleMesh& mesh, Visit visit) {
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t vertex : face)
      visit(mesh.positions[vertex]);
  }
}

Vec3 middle_of_bounds(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = low * -1;
  visit_corners(mesh, [&](const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  });
  return (low + high) * 0.5;
}

}  // namespace

std::array<Vec3, kViews> view_directions() {
  std::array<Vec3, kViews> directions;
  std::size_t count = 0;
  for (const double one : {1.0, -1.0}) {
    for (const double phi : {std::numbers::phi, -std::numbers::phi}) {
      for (const Vec3& direction : {Vec3{0, one, phi}, {one, phi, 0}, {phi, 0, one}})
        directions[count++] = direction;
    }
  }
  return directions;
}

Expected<std::array<Framing, kViews>> views_around(const TriangleMesh& reference) {
  const Vec3 centre = middle_of_bounds(reference);
  double radius = 0;
  visit_corners(reference, [&](const Vec3& p) { radius = std::max(radius, length(p - centre)); });
  if (!(radius > 0)) return fail(ErrorCode::kBadInput, "mesh B has no extent; give a surface");
  std::array<Framing, kViews> views;
  const auto directions = view_directions();
  for (std::size_t i = 0; i < kViews; ++i) {
    views[i] = {.centre = centre,
                .pixel = 2 * radius / (kViewSize - 2 * kMargin),
                .width = kViewSize,
                .height = kViewSize,
                .toward = directions[i]};
  }
  return views;
}

}  // namespace vitrine::inline codec
