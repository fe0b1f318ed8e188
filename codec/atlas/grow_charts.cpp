// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/grow_charts.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "codec/atlas/small_charts.h"

namespace vitrine::inline codec {
namespace {

constexpr double kMostSeeds = 40;
constexpr int kLloydRounds = 12;
constexpr int kSmoothings = 2;  // number of times the normals are smoothed
constexpr double kUnreached = std::numeric_limits<double>::infinity();

Vec3 unit_or_zero(const Vec3& v) {
  const double l = length(v);
  return l > 0 ? v * (1 / l) : Vec3{};
}

class ChartGrower {
 public:
  ChartGrower(const MeshView& mesh, const HalfEdges& edges) : mesh_(mesh), edges_(edges) {
    measure_faces();
    for (int i = 0; i < kSmoothings; ++i)
      smooth_normals();
    const double seeds = std::min(kMostSeeds, std::sqrt(static_cast<double>(size())));
    seed_count_ = static_cast<std::uint32_t>(seeds + 0.5);
    double area = 0;
    for (const double a : area_)
      area += a;
    unit_ = std::sqrt(area / seeds);
    if (!(unit_ > 0)) unit_ = 1;
  }

  std::vector<std::uint32_t> grow() {
    sow();
    for (int i = 0; i < kLloydRounds; ++i) {
      if (!move_seeds()) break;
      forget();
      for (std::uint32_t s = 0; s < seeds_.size(); ++s)
        start(s);
      spread();
    }
    return label_;
  }

 private:
  struct Reached {
    double cost;
    std::uint32_t face, label;
    // Reversed, so that the priority queue returns the cheapest face first.
    bool operator<(const Reached& o) const {
      if (cost != o.cost) return cost > o.cost;
      return face != o.face ? face > o.face : label > o.label;
    }
  };

  std::uint32_t size() const { return static_cast<std::uint32_t>(mesh_.faces.size()); }

  void measure_faces() {
    for (const auto& [a, b, c] : mesh_.faces) {
      const Vec3 &p = mesh_.positions[a], &q = mesh_.positions[b], &r = mesh_.positions[c];
      const Vec3 n = cross(q - p, r - p);
      centre_.push_back((p + q + r) * (1.0 / 3));
      area_.push_back(length(n) / 2);
      normal_.push_back(unit_or_zero(n));
    }
  }

  // Replaces the normal of each face by the mean normal of its vertices.
  void smooth_normals() {
    std::vector<Vec3> at_vertex(mesh_.positions.size());
    for (std::uint32_t f = 0; f < size(); ++f) {
      for (const std::uint32_t v : mesh_.faces[f])
        at_vertex[v] += normal_[f] * area_[f];
    }
    for (std::uint32_t f = 0; f < size(); ++f) {
      Vec3 sum;
      for (const std::uint32_t v : mesh_.faces[f])
        sum += at_vertex[v];
      normal_[f] = unit_or_zero(sum);
    }
  }

  void forget() {
    cost_.assign(size(), kUnreached);
    label_.assign(size(), 0);
  }
  void start(std::uint32_t seed) { reach({0, seeds_[seed], seed}); }

  void reach(const Reached& r) {
    if (r.cost >= cost_[r.face]) return;
    cost_[r.face] = r.cost;
    label_[r.face] = r.label;
    open_.push(r);
  }

  void spread() {
    while (!open_.empty()) {
      const Reached r = open_.top();
      open_.pop();
      if (r.cost > cost_[r.face] || r.label != label_[r.face]) continue;
      for (const std::uint32_t h : edges_[r.face]) {
        if (h / 3 != r.face) reach({r.cost + step(r.face, h / 3, r.label), h / 3, r.label});
      }
    }
  }

  double step(std::uint32_t from, std::uint32_t to, std::uint32_t label) const {
    const double turn = 1 - dot(normal_[to], normal_[seeds_[label]]);
    return length(centre_[to] - centre_[from]) / unit_ * (0.35 + turn + 4 * turn * turn);
  }

  // Places one seed in each component. Then places each further seed at the face with the greatest
  // cost.
  void sow() {
    forget();
    for (std::uint32_t f = 0; f < size(); ++f) {
      if (cost_[f] == kUnreached) sow_at(f);
    }
    while (seeds_.size() < seed_count_) {
      const auto farthest = std::max_element(cost_.begin(), cost_.end());
      if (*farthest == 0) break;
      sow_at(static_cast<std::uint32_t>(farthest - cost_.begin()));
    }
  }
  void sow_at(std::uint32_t face) {
    seeds_.push_back(face);
    start(static_cast<std::uint32_t>(seeds_.size() - 1));
    spread();
  }

  // Moves each seed to the face that is nearest to the mean point and normal of its chart. Returns
  // whether any seed moved.
  bool move_seeds() {
    std::vector<Vec3> point(seeds_.size()), normal(seeds_.size());
    std::vector<double> area(seeds_.size(), 0);
    for (std::uint32_t f = 0; f < size(); ++f) {
      point[label_[f]] += centre_[f] * area_[f];
      normal[label_[f]] += normal_[f] * area_[f];
      area[label_[f]] += area_[f];
    }
    std::vector<std::uint32_t> best = seeds_;
    std::vector<double> least(seeds_.size(), kUnreached);
    for (std::uint32_t f = 0; f < size(); ++f) {
      const std::uint32_t s = label_[f];
      if (!(area[s] > 0)) continue;
      const Vec3 offset = (centre_[f] - point[s] * (1 / area[s])) * (1 / unit_);
      const double distance = dot(offset, offset) + 1 - dot(normal_[f], unit_or_zero(normal[s]));
      if (distance < least[s]) least[s] = distance, best[s] = f;
    }
    seeds_.swap(best);
    return seeds_ != best;
  }

  const MeshView& mesh_;
  const HalfEdges& edges_;
  std::vector<Vec3> centre_, normal_;  // indexed by face
  std::vector<double> area_;           // indexed by face
  std::uint32_t seed_count_;
  double unit_;                       // side of a square with the mean area of a chart
  std::vector<std::uint32_t> seeds_;  // for each chart, its seed face
  std::vector<double> cost_;          // for each face, the cost from the seed of its chart
  std::vector<std::uint32_t> label_;  // for each face, its chart
  std::priority_queue<Reached> open_;
};

}  // namespace

std::vector<std::uint32_t> grow_charts(const MeshView& mesh, const HalfEdges& edges) {
  std::vector<std::uint32_t> labels = ChartGrower(mesh, edges).grow();
  smooth_borders(edges, labels);
  return merge_small_charts(mesh, edges, labels);
}

}  // namespace vitrine::inline codec
