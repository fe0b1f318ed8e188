// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/flat_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/atlas/conjugate_gradients.h"
#include "codec/mesh/symmetric_dirichlet.h"

namespace vitrine::inline codec {
namespace {

constexpr StoppingRule kConformalStop{.iterations = 600, .reduction = 1e-7};

// Multiplies two points of the plane as complex numbers.
Vec2 product(const Vec2& a, const Vec2& b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
Vec2 conjugate(const Vec2& a) {
  return {a.x, -a.y};
}

// The residual of a face is the sum, over its three corners, of weight times position in the plane.
// It is zero if the map is a similarity on the face.
using Weights = std::array<Vec2, 3>;

// The weight of a corner is the vector along the opposite side, in the plane of the face, divided
// by the square root of the face's area.
Weights weights_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double base = length(ab), area = doubled_area(ab, ac);
  if (!(base > 0)) return {};
  const Vec2 p{dot(ab, ac) / base, area / base};
  const double scale = 1 / std::sqrt(area);
  return {(p - Vec2{base, 0}) * scale, Vec2{-p.x, -p.y} * scale, Vec2{base, 0} * scale};
}

std::uint32_t farthest(const Chart& chart, std::span<const std::uint32_t> wedges,
                       std::uint32_t from) {
  std::uint32_t best = from;
  double most = -1;
  for (const std::uint32_t w : wedges) {
    const Vec3 d = chart.positions[w] - chart.positions[from];
    if (w != from && dot(d, d) > most) most = dot(d, d), best = w;
  }
  return best;
}

class ConformalMap {
 public:
  explicit ConformalMap(const Chart& chart) : chart_(chart), uv_(chart.positions.size()) {
    for (const auto& [a, b, c] : chart.wedges) {
      const std::vector<Vec3>& p = chart.positions;
      weights_.push_back(weights_of(p[a], p[b], p[c]));
    }
    pin();
  }

  std::vector<Vec2> solve() {
    std::vector<double> diagonal(uv_.size(), 0);
    for (std::uint32_t f = 0; f < chart_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k)
        diagonal[chart_.wedges[f][k]] += dot(weights_[f][k], weights_[f][k]);
    }
    std::vector<Vec2> residual = apply(uv_);
    for (Vec2& r : residual)
      r = r * -1;
    conjugate_gradients([&](const std::vector<Vec2>& x) { return apply(x); }, diagonal, residual,
                        uv_, kConformalStop);
    return uv_;
  }

 private:
  void pin() {
    std::vector<std::uint32_t> boundary;
    for (std::uint32_t h = 0; h < 3 * chart_.size(); ++h) {
      if (across(chart_.edges, h) == h) boundary.push_back(chart_.wedges[h / 3][h % 3]);
    }
    pinned_[0] = farthest(chart_, boundary, boundary[0]);
    pinned_[1] = farthest(chart_, boundary, pinned_[0]);
    uv_[pinned_[1]].x = length(chart_.positions[pinned_[1]] - chart_.positions[pinned_[0]]);
  }

  // Returns the product of the normal equations' matrix and x. Entries of the pinned wedges are
  // zero.
  std::vector<Vec2> apply(const std::vector<Vec2>& x) const {
    std::vector<Vec2> image(x.size());
    for (std::uint32_t f = 0; f < chart_.size(); ++f) {
      const Triangle& w = chart_.wedges[f];
      Vec2 residual;
      for (std::size_t k = 0; k < 3; ++k)
        residual = residual + product(weights_[f][k], x[w[k]]);
      for (std::size_t k = 0; k < 3; ++k)
        image[w[k]] = image[w[k]] + product(conjugate(weights_[f][k]), residual);
    }
    image[pinned_[0]] = image[pinned_[1]] = {};
    return image;
  }

  const Chart& chart_;
  std::vector<Vec2> uv_;
  std::vector<Weights> weights_;  // indexed by face
  std::array<std::uint32_t, 2> pinned_;
};

}  // namespace

std::vector<Vec2> conformal_map(const Chart& chart) {
  return ConformalMap(chart).solve();
}

}  // namespace vitrine::inline codec
