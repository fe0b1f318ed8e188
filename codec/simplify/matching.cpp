// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/matching.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "codec/format/placement.h"

namespace vitrine::inline codec {
namespace {

// The share of a collapse's error that is left out of its cost, because the display filter removes
// it: the filter lifts midpoints that have sunk below a curved surface. The filter of fine levels
// is weaker, because their rounding is as large as their error.
constexpr double kLiftedRegular = 0.6, kLifted = 0.9;
// The share of the edges, cheapest first, that may collapse in a level. With fewer edges, the
// levels follow the surface more closely. With more edges, there are fewer levels. Chosen by
// measuring the rate-distortion curve.
constexpr double kCheapRegular = 0.7, kCheap = 0.6;
// Costs within the same eighth of an octave count as equal. Edges of equal cost stay in the order
// of their vertices, which is an order in space. Therefore a level passes through memory in a few
// dozen sweeps instead of at random.
constexpr int kStepBits = 3;
// The `reach` of keeps_near(), as a share of the mean edge length. A smaller reach lowers the
// maximum error but leaves more of a rough surface to later levels.
constexpr double kReachRegular = 0.1, kReach = 0.25;

// Returns a sort key for the cost. The bits of a non-negative float ascend with its value.
std::uint32_t cost_key(double cost) {
  constexpr int kFraction = std::numeric_limits<float>::digits - 1;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(std::max(cost, 0.0)));
  return bits >> (kFraction - kStepBits);
}

}  // namespace

const std::vector<Pick>& CollapseMatcher::match(const LevelRules& rules) {
  is_taken_.assign(surface_.position.size(), 0);
  if (rules.placement == Placement::kPyramid) sum_rings();
  list_edges(rules);
  radix_sort(edges_, scratch_);

  picks_.clear();
  const double share = rules.is_regular ? kCheapRegular : kCheap;
  const auto cheap = static_cast<std::size_t>(static_cast<double>(edges_.size()) * share);
  reach_ = mean_edge_ * (rules.is_regular ? kReachRegular : kReach);
  choose(rules, {edges_.data(), cheap}, rules.most);
  const std::size_t enough = std::min<std::size_t>(rules.most, surface_.live.size() / 5);
  if (picks_.size() < enough) {
    // Few edges pass on a rough surface, so all edges are tried with the larger reach.
    reach_ = mean_edge_ * kReach;
    choose(rules, edges_, enough);
  }
  const auto target_less = [](const Pick& a, const Pick& b) { return a.target < b.target; };
  const auto target_same = [](const Pick& a, const Pick& b) { return a.target == b.target; };
  std::stable_sort(picks_.begin(), picks_.end(), target_less);
  picks_.erase(std::unique(picks_.begin(), picks_.end(), target_same), picks_.end());
  return picks_;
}

void CollapseMatcher::sum_rings() {
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

void CollapseMatcher::list_edges(const LevelRules& rules) {
  edges_.clear();
  const double lifted = rules.is_regular ? kLiftedRegular : kLifted;
  double lengths = 0;
  const Connectivity& mesh = surface_.mesh;
  for (VertexId v : surface_.live) {
    const Corner first = mesh.corner_at(v);
    Corner c = first;
    do {
      const VertexId w = mesh.neighbour(c);
      const bool listed = !is_virtual(w) && v < w &&
                          !(rules.keeps_regions && surface_.region[v] != surface_.region[w]);
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

// Estimates v~ in a fraction of the time of merged_position(). The result is exact for midpoint
// placement, and exact up to rounding for pyramid placement. The rounding of midpoints matters: of
// two equal edges, only one may round onto the surface.
Vec3 CollapseMatcher::likely_target(const LevelRules& rules, Corner c) const {
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
  // Each ring includes the other end of the edge and the opposite vertices.
  const std::uint32_t both = ring_size_[v] + ring_size_[w], shared = 2 + 2 * m;
  if (m == 0 || both <= shared) return middle;
  const Vec3 far = ring_sum_[v] + ring_sum_[w] - p - q - near * 2;
  return middle + near * (1.0 / (4 * m)) - far * (1.0 / (4 * (both - shared)));
}

void CollapseMatcher::choose(const LevelRules& rules, std::span<const KeyedIndex> edges,
                             std::size_t enough) {
  for (const KeyedIndex& edge : edges) {
    if (picks_.size() >= enough) return;
    choose(rules, edge.index);
  }
}

void CollapseMatcher::choose(const LevelRules& rules, Corner c) {
  const Connectivity& mesh = surface_.mesh;
  if (is_taken_[mesh.vertex(c)] || is_taken_[mesh.neighbour(c)]) return;
  const EdgeStar edge(mesh, c);
  if (!keeps_manifold(mesh, edge)) return;
  const Vec3i target = merged_position(surface_, edge, rules.placement, rules.parity);
  if (!rules.allows(target) || !keeps_shape(edge, target)) return;
  is_taken_[edge.v1] = is_taken_[edge.v2] = 1;
  withhold_neighbours(rules, edge);
  picks_.push_back({c, target});
}

void CollapseMatcher::withhold_neighbours(const LevelRules& rules, const EdgeStar& edge) {
  const bool all = rules.placement == Placement::kPyramid;
  if (!all && !rules.keeps_regions) return;
  const std::uint16_t own = surface_.region[edge.v1];
  for (const Star* star : {&edge.star1, &edge.star2}) {
    for (VertexId v : star->neighbours()) {
      if (!is_virtual(v) && (all || surface_.region[v] != own)) is_taken_[v] = 1;
    }
  }
}

}  // namespace vitrine::inline codec
