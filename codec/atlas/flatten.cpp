// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/atlas/chart_areas.h"
#include "codec/atlas/flat_maps.h"
#include "codec/mesh/symmetric_dirichlet.h"

namespace vitrine::inline codec {
namespace {

constexpr int kSweeps = 100;
constexpr int kDirections = 32;
// relaxation stops once no wedge moves farther than this, in mean edge lengths
constexpr double kStill = 1e-4;

bool has_flipped_face(const Chart& chart) {
  for (std::uint32_t f = 0; f < chart.size(); ++f) {
    if (!(area_in_plane(chart, f) > 0)) return true;
  }
  return false;
}

void scale(Chart& chart, double by) {
  if (!(by > 0 && by < 1e100)) return;
  for (Vec2& uv : chart.uv)
    uv = uv * by;
}

double area_in_space(const Chart& chart) {
  double sum = 0;
  for (std::uint32_t f = 0; f < chart.size(); ++f)
    sum += area_in_space(chart, f);
  return sum;
}

void keep_area(Chart& chart) {
  double plane = 0;
  for (std::uint32_t f = 0; f < chart.size(); ++f)
    plane += area_in_plane(chart, f);
  scale(chart, std::sqrt(area_in_space(chart) / plane));
}

// Lowers the symmetric Dirichlet energy of a chart by moving one wedge at a time.
class Relaxation {
 public:
  explicit Relaxation(Chart& chart) : chart_(chart), corners_(chart.positions.size()) {
    for (std::uint32_t c = 0; c < 3 * chart.size(); ++c)
      corners_[chart.wedges[c / 3][c % 3]].push_back(c);
    still_ = kStill * std::sqrt(area_in_space(chart) / chart.size());
  }

  void run() {
    find_scale();
    for (int i = 0; i < kSweeps && sweep() > still_; ++i) {
    }
  }

 private:
  // Returns the face (a, b, c) as a function of the position of corner a.
  EnergyTriangle triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec3& from = chart_.positions[a];
    return {chart_.uv[b], chart_.uv[c],
            TriangleShape(chart_.positions[b] - from, chart_.positions[c] - from)};
  }

  // Scales the chart so that its energy is least. A face's energy is D + D / d^2, where D is its
  // Dirichlet energy and d its area ratio. A factor of s multiplies the first term by s^2 and
  // divides the second one by s^2.
  void find_scale() {
    double stretched = 0, shrunk = 0;
    for (std::uint32_t f = 0; f < chart_.size(); ++f) {
      const auto& [a, b, c] = chart_.wedges[f];
      const EnergyTriangle face = triangle(a, b, c);
      const Vec2& at = chart_.uv[a];
      const double ratio = face.area(at) / face.area_in_space(), dirichlet = face.dirichlet(at);
      if (!(ratio > 0)) continue;
      stretched += dirichlet;
      shrunk += dirichlet / (ratio * ratio);
    }
    scale(chart_, std::sqrt(std::sqrt(shrunk / stretched)));
  }

  // Moves each wedge once. Returns the largest move along one axis.
  double sweep() {
    double farthest = 0;
    for (std::uint32_t w = 0; w < corners_.size(); ++w) {
      star_.clear();
      for (const std::uint32_t c : corners_[w]) {
        const Triangle& f = chart_.wedges[c / 3];
        star_.push_back(
            triangle(w, f[next_half_edge(c) % 3], f[next_half_edge(next_half_edge(c)) % 3]));
      }
      const Vec2 moved = relaxed(chart_.uv[w], 1, star_);
      const Vec2 by = moved - chart_.uv[w];
      farthest = std::max({farthest, std::abs(by.x), std::abs(by.y)});
      chart_.uv[w] = moved;
    }
    return farthest;
  }

  Chart& chart_;
  std::vector<std::vector<std::uint32_t>> corners_;  // for each wedge, its corners
  double still_;
  std::vector<EnergyTriangle> star_;
};

// Returns the width and height of the chart's bounding box whose sides are parallel and
// perpendicular to `direction`.
Vec2 box_side(const Chart& chart, const Vec2& direction) {
  const double far = std::numeric_limits<double>::infinity();
  Vec2 low{far, far}, high{-far, -far};
  for (const Vec2& uv : chart.uv) {
    const double along = dot(uv, direction), beside = cross(direction, uv);
    low = {std::min(low.x, along), std::min(low.y, beside)};
    high = {std::max(high.x, along), std::max(high.y, beside)};
  }
  return high - low;
}

// Rotates the chart so that its bounding box has the smallest area, with the long side horizontal.
// Tries 32 directions within a quarter turn.
void lie_flat(Chart& chart) {
  Vec2 best{1, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const Vec2 direction = on_circle(0.25 * i / kDirections);
    const Vec2 box = box_side(chart, direction);
    if (box.x * box.y >= least) continue;
    least = box.x * box.y;
    best = box.x >= box.y ? direction : Vec2{-direction.y, direction.x};
  }
  for (Vec2& uv : chart.uv)
    uv = {dot(uv, best), cross(best, uv)};
}

}  // namespace

void flatten(Chart& chart) {
  chart.uv = conformal_map(chart);
  if (has_flipped_face(chart)) chart.uv = tutte_embedding(chart);
  Relaxation(chart).run();
  keep_area(chart);
  lie_flat(chart);
}

}  // namespace vitrine::inline codec
