// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/matching.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "codec/progressive/placement.h"

namespace vitrine {
namespace {

// Where midpoints sink below a curved surface the display filter lifts them again: that share of
// the error is not seen and keeps no vertex. In fine levels, where errors are rounding as much, the
// filter is weaker.
constexpr double kLiftedRegular = 0.6, kLifted = 0.9;
// Shares of the edges, cheapest first, that a level may take: fewer follow the surface closer,
// more need fewer levels. Measured on the rate-distortion curve.
constexpr double kCheapRegular = 0.7, kCheap = 0.6;
// Costs are told apart in steps of an eighth. Within one the edges stay in the order of their
// vertices, which is that of space: a level goes through memory in some dozens of sweeps, not at
// random.
constexpr int kStepBits = 3;
// Of keeps_near(), shares of the mean edge: the closer, the smaller is the largest error, and the
// more of a rough surface stays until later.
constexpr double kReachRegular = 0.1, kReach = 0.25;

// Costs are not negative, so that their bits ascend with them.
std::uint32_t cost_key(double cost) {
  constexpr int kFraction = std::numeric_limits<float>::digits - 1;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(std::max(cost, 0.0)));
  return bits >> (kFraction - kStepBits);
}

}  // namespace

const std::vector<Pick>& Matcher::match(const LevelRules& rules) {
  taken_.assign(surface_.position.size(), 0);
  if (rules.placement == Placement::kPyramid) sum_rings();
  list_edges(rules);
  radix_sort(edges_, scratch_);

  picks_.clear();
  const double share = rules.regular ? kCheapRegular : kCheap;
  const auto cheap = static_cast<std::size_t>(static_cast<double>(edges_.size()) * share);
  reach_ = mean_edge_ * (rules.regular ? kReachRegular : kReach);
  choose(rules, {edges_.data(), cheap}, rules.most);
  const std::size_t enough = std::min<std::size_t>(rules.most, surface_.live.size() / 5);
  if (picks_.size() < enough) {  // a rough surface must get on, too
    reach_ = mean_edge_ * kReach;
    choose(rules, edges_, enough);
  }
  const auto target_less = [](const Pick& a, const Pick& b) { return a.target < b.target; };
  const auto target_same = [](const Pick& a, const Pick& b) { return a.target == b.target; };
  std::stable_sort(picks_.begin(), picks_.end(), target_less);
  picks_.erase(std::unique(picks_.begin(), picks_.end(), target_same), picks_.end());
  return picks_;
}

void Matcher::sum_rings() {
  ring_sum_.resize(surface_.position.size());
  ring_size_.resize(surface_.position.size());
  const Connectivity& mesh = surface_.mesh;
  for (VertexId v : surface_.live) {
    Vec3 sum;
    std::uint32_t size = 0;
    const Corner first = mesh.corner_at(v);
    Corner c = first;
    do {
      const VertexId w = mesh.neighbour(c);
      if (!is_virtual(w)) sum += surface_.point(w), ++size;
      c = mesh.swing(c);
    } while (c != first);
    ring_sum_[v] = sum, ring_size_[v] = size;
  }
}

void Matcher::list_edges(const LevelRules& rules) {
  edges_.clear();
  const double lifted = rules.regular ? kLiftedRegular : kLifted;
  double lengths = 0;
  const Connectivity& mesh = surface_.mesh;
  for (VertexId v : surface_.live) {
    const Corner first = mesh.corner_at(v);
    Corner c = first;
    do {
      const VertexId w = mesh.neighbour(c);
      const bool listed =
          !is_virtual(w) && v < w && !(rules.by_region && surface_.region[v] != surface_.region[w]);
      if (listed) {
        Quadric both = surface_.quadric[v];
        both += surface_.quadric[w];
        const Vec3 target = likely_target(rules, c), d = surface_.point(v) - surface_.point(w);
        const double displayed = both.at(target) - lifted * both.mendable(target);
        const double regular = rules.length_weight * dot(d, d) * both.weight();
        lengths += length(d);
        edges_.push_back({cost_key(displayed + regular), c});
      }
      c = mesh.swing(c);
    } while (c != first);
  }
  mean_edge_ = lengths / static_cast<double>(std::max<std::size_t>(edges_.size(), 1));
}

// v~, of pyramid placement up to rounding, for a fraction of the price of merged_position(). How
// midpoints round counts: of edges that are equal else, one may round onto the surface.
Vec3 Matcher::likely_target(const LevelRules& rules, Corner c) const {
  const Connectivity& mesh = surface_.mesh;
  const VertexId v = mesh.vertex(c), w = mesh.neighbour(c);
  if (rules.placement == Placement::kMidpoint) {
    const Vec3i r = midpoint_term(rules.parity);
    return surface_.middle(merge(surface_.position[v], surface_.position[w], r));
  }
  const Vec3 p = surface_.point(v), q = surface_.point(w);
  const Vec3 middle = (p + q) * 0.5;
  Vec3 near;
  std::uint32_t m = 0;
  for (VertexId apex : {mesh.vertex(prev(c)), mesh.vertex(mesh.opposite(prev(c)))}) {
    if (!is_virtual(apex)) near += surface_.point(apex), ++m;
  }
  // Both rings hold the other end and the opposite vertices.
  const std::uint32_t both = ring_size_[v] + ring_size_[w], shared = 2 + 2 * m;
  if (m == 0 || both <= shared) return middle;
  const Vec3 far = ring_sum_[v] + ring_sum_[w] - p - q - near * 2;
  return middle + near * (1.0 / (4 * m)) - far * (1.0 / (4 * (both - shared)));
}

void Matcher::choose(const LevelRules& rules, std::span<const KeyedIndex> edges,
                     std::size_t enough) {
  for (const KeyedIndex& edge : edges) {
    if (picks_.size() >= enough) return;
    choose(rules, edge.index);
  }
}

void Matcher::choose(const LevelRules& rules, Corner c) {
  const Connectivity& mesh = surface_.mesh;
  if (taken_[mesh.vertex(c)] || taken_[mesh.neighbour(c)]) return;
  const EdgeStar edge(mesh, c);
  if (!keeps_manifold(mesh, edge)) return;
  const Vec3i target = merged_position(surface_, edge, rules.placement, rules.parity);
  if (!rules.allow(target) || !keeps_shape(edge, target)) return;
  taken_[edge.v1] = taken_[edge.v2] = 1;
  withhold_neighbours(rules, edge);
  picks_.push_back({c, target});
}

void Matcher::withhold_neighbours(const LevelRules& rules, const EdgeStar& edge) {
  const bool all = rules.placement == Placement::kPyramid;
  if (!all && !rules.by_region) return;
  const std::uint16_t own = surface_.region[edge.v1];
  for (const Star* star : {&edge.star1, &edge.star2}) {
    for (VertexId v : star->neighbours()) {
      if (!is_virtual(v) && (all || surface_.region[v] != own)) taken_[v] = 1;
    }
  }
}

}  // namespace vitrine
