// SPDX-License-Identifier: Apache-2.0
#include "codec/plan/view.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNearest = 1e-3;  // minimum depth, relative to the diagonal of the box

Vec3 column(const View& view, std::size_t k) {
  return {view.camera[4 * k], view.camera[4 * k + 1], view.camera[4 * k + 2]};
}

// Returns half the height of the view at distance 1 from the eye.
double slope_of(const View& view) {
  return std::tan(view.field_of_view * 0.5 * kDegree);
}

struct ModelBox {
  Vec3 low, high;

  Vec3 corner(unsigned bits) const {
    return {bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z};
  }
};

// An interval of the parameter t of a line.
struct Stretch {
  double from = 0, to = std::numeric_limits<double>::infinity();

  // Keeps the part of the interval in which height + t * slope >= 0.
  void keep(double height, double slope) {
    if (slope > 0) {
      from = std::max(from, -height / slope);
    } else if (slope < 0) {
      to = std::min(to, height / -slope);
    } else if (height < 0) {
      to = -1;
    }
  }
  bool is_empty() const { return from > to; }
};

// The visible pyramid of a camera; its apex is the eye. `inwards_` holds the normals of its sides,
// which point inwards. `edges_` holds the directions of its edges.
class Sight {
 public:
  explicit Sight(const View& view) : eye_(column(view, 3)) {
    const Vec3 right = column(view, 0), up = column(view, 1), back = column(view, 2);
    const double y = slope_of(view), x = y * view.width / view.height;
    ahead_ = back * (-1 / length(back));
    inwards_ = {right - back * x, right * -1.0 - back * x, up - back * y, up * -1.0 - back * y};
    std::size_t corner = 0;
    for (const double sx : {-x, x}) {
      for (const double sy : {-y, y})
        edges_[corner++] = right * sx + up * sy - back;
    }
  }

  // Returns the depth of the nearest visible point of a box, or infinity if no part of the box is
  // visible. The visible part is convex, and its corners lie on edges of the box or of the pyramid.
  double nearest(const ModelBox& box) const {
    double depth = std::numeric_limits<double>::infinity();
    for (unsigned corner = 0; corner < 8; ++corner) {
      for (const unsigned axis : {1u, 2u, 4u}) {
        if ((corner & axis) == 0)
          depth = std::min(depth, nearest(box.corner(corner), box.corner(corner | axis)));
      }
    }
    for (const Vec3& edge : edges_)
      depth = std::min(depth, nearest(edge, box));
    return depth;
  }

 private:
  // Returns the depth of the nearest visible point on the segment from a to b, or infinity if no
  // part of the segment is visible.
  double nearest(const Vec3& a, const Vec3& b) const {
    const Vec3 start = a - eye_, way = b - a;
    Stretch seen{0, 1};
    for (const Vec3& side : inwards_)
      seen.keep(dot(start, side), dot(way, side));
    if (seen.is_empty()) return std::numeric_limits<double>::infinity();
    return std::min(dot(start + way * seen.from, ahead_), dot(start + way * seen.to, ahead_));
  }
  // Returns the depth at which an edge of the pyramid enters the box, or infinity if the edge
  // misses the box.
  double nearest(const Vec3& edge, const ModelBox& box) const {
    const Vec3 above = eye_ - box.low, below = box.high - eye_;
    Stretch inside;
    inside.keep(above.x, edge.x), inside.keep(below.x, -edge.x);
    inside.keep(above.y, edge.y), inside.keep(below.y, -edge.y);
    inside.keep(above.z, edge.z), inside.keep(below.z, -edge.z);
    if (inside.is_empty()) return std::numeric_limits<double>::infinity();
    return inside.from * dot(edge, ahead_);
  }

  Vec3 eye_, ahead_;
  std::array<Vec3, 4> inwards_, edges_;
};

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
  const ModelBox grown{lattice.to_model(box.low) - margin, lattice.to_model(box.high) + margin};
  const double least = kNearest * length(grown.high - grown.low);
  const double depth = std::max(Sight(view).nearest(grown), least);
  return depth > 0 ? error / depth * view.height / (2 * slope_of(view)) : 0;
}

}  // namespace vitrine::inline codec
