// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/flat_maps.h"

#include <algorithm>
#include <cmath>

#include "codec/atlas/conjugate_gradients.h"
#include "codec/atlas/flat_maps.h"

namespace vitrine::inline codec {
namespace {

constexpr StoppingRule kTutteStop{.iterations = 2000, .reduction = 1e-13};

using BoundaryLoop = std::vector<std::uint32_t>;

class TutteEmbedding {
 public:
  explicit TutteEmbedding(const Chart& chart) : chart_(chart) {
    const std::vector<BoundaryLoop> loops = boundary_loops(chart.edges);
    const auto longest = std::max_element(
        loops.begin(), loops.end(),
        [&](const BoundaryLoop& a, const BoundaryLoop& b) { return length_of(a) < length_of(b); });
    uv_.resize(chart.positions.size() + loops.size());
    is_fixed_.resize(uv_.size(), 0);
    join_faces();
    for (auto loop = loops.begin(); loop != loops.end(); ++loop) {
      if (loop == longest) {
        put_on_circle(*loop);
      } else {
        fill_hole(*loop, chart.positions.size() + (loop - loops.begin()));
      }
    }
  }

  std::vector<Vec2> solve() {
    std::vector<double> valence(uv_.size(), 0);
    for (const auto& [a, b] : links_)
      ++valence[a], ++valence[b];
    std::vector<Vec2> residual = apply(uv_);
    for (Vec2& r : residual)
      r = r * -1;
    conjugate_gradients([&](const std::vector<Vec2>& x) { return apply(x); }, valence, residual,
                        uv_, kTutteStop);
    uv_.resize(chart_.positions.size());
    return uv_;
  }

 private:
  struct Link {
    std::size_t a, b;
  };

  std::uint32_t start(std::uint32_t h) const { return chart_.wedges[h / 3][h % 3]; }
  double edge_length(std::uint32_t h) const {
    return length(chart_.positions[start(next_half_edge(h))] - chart_.positions[start(h)]);
  }
  double length_of(const BoundaryLoop& loop) const {
    double sum = 0;
    for (const std::uint32_t h : loop)
      sum += edge_length(h);
    return sum;
  }

  void join_faces() {
    for (std::uint32_t h = 0; h < 3 * chart_.size(); ++h) {
      if (across(chart_.edges, h) >= h) links_.push_back({start(h), start(next_half_edge(h))});
    }
  }

  // Spaces the wedges on the circle in proportion to their edge lengths. An edge shorter than a
  // hundredth of the mean edge gets a hundredth of the mean edge.
  void put_on_circle(const BoundaryLoop& loop) {
    const double whole = length_of(loop);
    const double least = whole > 0 ? whole / (100.0 * static_cast<double>(loop.size())) : 1;
    double sum = 0, at = 0;
    for (const std::uint32_t h : loop)
      sum += std::max(edge_length(h), least);
    for (const std::uint32_t h : loop) {
      uv_[start(h)] = on_circle(at / sum);
      is_fixed_[start(h)] = 1;
      at += std::max(edge_length(h), least);
    }
  }

  void fill_hole(const BoundaryLoop& loop, std::size_t middle) {
    for (const std::uint32_t h : loop)
      links_.push_back({start(h), middle});
  }

  // Returns the product of the graph's Laplacian matrix and x. Sets the entries of the fixed wedges
  // to zero.
  std::vector<Vec2> apply(const std::vector<Vec2>& x) const {
    std::vector<Vec2> image(x.size());
    for (const auto& [a, b] : links_) {
      const Vec2 d = x[a] - x[b];
      image[a] = image[a] + d;
      image[b] = image[b] - d;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (is_fixed_[i]) image[i] = {};
    }
    return image;
  }

  const Chart& chart_;
  std::vector<Vec2> uv_;                // positions of the wedges, then of the hole centres
  std::vector<std::uint8_t> is_fixed_;  // for each entry of uv_, whether it is fixed
  std::vector<Link> links_;
};

}  // namespace

std::vector<Vec2> tutte_embedding(const Chart& chart) {
  return TutteEmbedding(chart).solve();
}

}  // namespace vitrine::inline codec
