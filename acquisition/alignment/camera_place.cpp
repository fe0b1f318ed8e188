// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/camera_place.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

using Columns = std::array<Vec3, 3>;  // a 3 x 3 matrix, as its three columns

// Four pixels around the middle (u, v) of the mapped area, and their positions in the laser plane.
struct Quadrangle {
  double u = 0, v = 0, half_u = 0, half_v = 0;
  // Positions of the pixels (u - half_u, v - half_v), (u + half_u, v - half_v),
  // (u + half_u, v + half_v) and (u - half_u, v + half_v), in this order.
  std::array<PlanePoint, 4> at;
};

// Tries quadrangles of four sizes. Returns the largest quadrangle whose corners the map covers, or
// nullopt if it covers none of them.
std::optional<Quadrangle> quadrangle_of(const PlaneMap& map) {
  double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
  const auto hull = map.hull();
  for (std::size_t i = 0; i + 1 < hull.size(); i += 2) {
    low_u = std::min(low_u, hull[i]), high_u = std::max(high_u, hull[i]);
    low_v = std::min(low_v, hull[i + 1]), high_v = std::max(high_v, hull[i + 1]);
  }
  for (const double size : {.8, .6, .4, .2}) {
    Quadrangle q{.u = (low_u + high_u) / 2,
                 .v = (low_v + high_v) / 2,
                 .half_u = size * (high_u - low_u) / 2,
                 .half_v = size * (high_v - low_v) / 2};
    std::size_t inside = 0;
    for (const auto& [s, t] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      if (const auto at = map.at(q.u + s * q.half_u, q.v + t * q.half_v)) q.at[inside++] = *at;
    }
    if (inside == 4) return q;
  }
  return std::nullopt;
}

// Returns the homography from the unit square to the four points ([Heckbert89]).
std::optional<Columns> from_unit_square(const std::array<PlanePoint, 4>& p) {
  const double dx1 = p[1].x - p[2].x, dx2 = p[3].x - p[2].x,
               dx3 = p[0].x - p[1].x + p[2].x - p[3].x;
  const double dy1 = p[1].y - p[2].y, dy2 = p[3].y - p[2].y,
               dy3 = p[0].y - p[1].y + p[2].y - p[3].y;
  const double area = dx1 * dy2 - dx2 * dy1;
  if (area == 0) return std::nullopt;
  const double g = (dx3 * dy2 - dx2 * dy3) / area, h = (dx1 * dy3 - dx3 * dy1) / area;
  return Columns{Vec3{p[1].x - p[0].x + g * p[1].x, p[1].y - p[0].y + g * p[1].y, g},
                 Vec3{p[3].x - p[0].x + h * p[3].x, p[3].y - p[0].y + h * p[3].y, h},
                 Vec3{p[0].x, p[0].y, 1}};
}

// Returns the inverse of the homography, up to a factor.
Columns inverse_of(const Columns& m) {
  const Vec3 a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
  return {Vec3{a.x, b.x, c.x}, Vec3{a.y, b.y, c.y}, Vec3{a.z, b.z, c.z}};
}

// Returns the homography from the laser plane to pixels, relative to the middle of the sensor
// region (Calibration::region).
std::optional<Columns> to_pixels(const Calibration& calibration) {
  const auto q = quadrangle_of(calibration.map);
  const auto square = q ? from_unit_square(q->at) : std::nullopt;
  if (!square) return std::nullopt;
  Columns to = inverse_of(*square);
  const double left = q->u - q->half_u - calibration.region.width / 2.,
               top = q->v - q->half_v - calibration.region.height / 2.;
  for (Vec3& c : to)
    c = {2 * q->half_u * c.x + left * c.z, 2 * q->half_v * c.y + top * c.z, c.z};
  return to;
}

}  // namespace

std::optional<TablePoint> camera_place(const Calibration& calibration) {
  const auto pixels = to_pixels(calibration);
  if (!pixels) return std::nullopt;
  const auto& [p, q, origin] = *pixels;
  // Uses two conditions. If u and v are divided by the focal length f, the images of the x and y
  // directions have equal lengths and are perpendicular. Both conditions are linear in 1 / f².
  const double skew = p.x * q.x + p.y * q.y,
               stretch = p.x * p.x + p.y * p.y - q.x * q.x - q.y * q.y, skew_depth = p.z * q.z,
               stretch_depth = p.z * p.z - q.z * q.z,
               per_squared = -(skew * skew_depth + stretch * stretch_depth) /
                             (skew * skew + stretch * stretch);
  if (!(per_squared > 0) || !std::isfinite(per_squared)) return std::nullopt;
  const double per = std::sqrt(per_squared);
  const auto scaled = [&](const Vec3& c) { return Vec3{c.x * per, c.y * per, c.z}; };
  const double size = (length(scaled(p)) + length(scaled(q))) / 2, front = origin.z < 0 ? -1 : 1;
  const Vec3 x = scaled(p) * (front / size), y = scaled(q) * (front / size),
             shift = scaled(origin) * (front / size);
  TurntableAxis axis = calibration.axis;
  // about() takes only points of the laser plane, but the camera is outside of it. Therefore moves
  // the axis instead of the camera, by the opposite distance.
  axis.offset += dot(cross(x, y), shift);
  return about(axis, {-dot(x, shift), -dot(y, shift)});
}

}  // namespace vitrine::acquisition
