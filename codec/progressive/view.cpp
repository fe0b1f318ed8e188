// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/view.h"

#include <algorithm>
#include <cmath>

namespace vitrine {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNearest = 1e-3;  // of the box' diagonal

Vec3 column(const View& view, std::size_t k) {
  return {view.camera[4 * k], view.camera[4 * k + 1], view.camera[4 * k + 2]};
}

// Half of the viewport's height at distance 1.
double slope_of(const View& view) {
  return std::tan(view.field_of_view * 0.5 * kDegree);
}

// How much farther a point in sight is from the eye than it is deep, at most: in the corners.
double slant_of(const View& view) {
  const double y = slope_of(view), x = y * view.width / view.height;
  return std::sqrt(1 + x * x + y * y);
}

struct Box {
  Vec3 low, high;

  // The largest dot product of a point of the box with d.
  double reach(const Vec3& d) const {
    return (d.x > 0 ? high.x : low.x) * d.x + (d.y > 0 ? high.y : low.y) * d.y +
           (d.z > 0 ? high.z : low.z) * d.z;
  }
  double distance(const Vec3& p) const {
    const auto outside = [](double v, double from, double to) {
      return std::max({from - v, 0.0, v - to});
    };
    return length(Vec3{outside(p.x, low.x, high.x), outside(p.y, low.y, high.y),
                       outside(p.z, low.z, high.z)});
  }
};

// The box may touch all five inner sides: in front, and within the four planes through the eye.
bool in_sight(const Box& box, const View& view) {
  const Vec3 right = column(view, 0), up = column(view, 1), back = column(view, 2),
             eye = column(view, 3);
  const double y = slope_of(view), x = y * view.width / view.height;
  for (const Vec3& inwards : {back * -1.0, right - back * x, right * -1.0 - back * x, up - back * y,
                              up * -1.0 - back * y}) {
    if (box.reach(inwards) < dot(eye, inwards)) return false;
  }
  return true;
}

// How deep what is in sight of the box lies at least: as its nearest corner does, or, where that is
// beside or behind the eye, as a point in the corner of the viewport would.
double depth_of(const Box& box, const View& view) {
  const Vec3 back = column(view, 2), eye = column(view, 3);
  const double distance = std::max(box.distance(eye), kNearest * length(box.high - box.low));
  return std::max(distance / slant_of(view), (dot(eye, back) - box.reach(back)) / length(back));
}

}  // namespace

bool is_sane(const View& view) {
  const auto positive = [](double v) { return v > 0 && v < 1e9; };
  const bool finite = std::all_of(view.camera.begin(), view.camera.end(),
                                  [](double v) { return v > -1e30 && v < 1e30; });
  return finite && length(column(view, 2)) > 0 && positive(view.field_of_view) &&
         view.field_of_view < 180 && positive(view.width) && positive(view.height) &&
         positive(view.pixel_error) && view.bytes >= 0;
}

double pixels_of(double error, const LatticeBox& box, const Lattice& lattice, const View& view) {
  const Vec3 margin{error, error, error};
  const Box grown{lattice.to_model(box.low) - margin, lattice.to_model(box.high) + margin};
  if (!in_sight(grown, view)) return 0;
  const double depth = depth_of(grown, view);
  return depth > 0 ? error / depth * view.height / (2 * slope_of(view)) : 0;
}

}  // namespace vitrine
