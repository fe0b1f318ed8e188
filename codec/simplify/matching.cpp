// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/matching.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "codec/core/parallel.h"
#include "codec/format/placement.h"

namespace vitrine::inline codec {
namespace {

// Shares of a collapse's error that do not count as its cost, because the display filter removes
// them: the filter lifts midpoints that have sunk below a curved surface. In the regular (finest)
// levels, the filter is weaker, because rounding is as large as the error.
constexpr double kLiftedRegular = 0.6, kLifted = 0.9;
// Share of the edges, cheapest first, that may collapse in a level. A smaller share follows the
// surface more closely; a larger one gives fewer levels. The values were chosen by measuring
// rate-distortion curves.
constexpr double kCheapRegular = 0.7, kCheap = 0.6;
// Costs within the same eighth of an octave (a factor of 2) count as equal. Edges of equal cost
// stay in the order of their vertices, which are sorted in space (order_in_space.h). A level
// therefore sweeps through memory a few dozen times instead of jumping at random.
constexpr int kStepBits = 3;
// The limit for keeps_near(), as a share of the mean edge length. A smaller limit reduces the
// maximum error but leaves more collapses of a rough surface to later levels.
constexpr double kReachRegular = 0.1, kReach = 0.25;
// Number of vertices whose edges one call of edges_at() lists. It must not depend on the number of
// threads, because it determines the order in which edge lengths are added, and so the rounding of
// their sum.
constexpr std::size_t kListed = 8192;
// kChecked: number of edges that several threads check before one of these edges is chosen.
// kCheckedAtOnce: number of edges that one call checks.
constexpr std::size_t kChecked = 16'384, kCheckedAtOnce = 256;

// Returns a sort key for the cost. The bits of non-negative floats are in the same order as the
// floats.
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
    // On a rough surface, few edges pass the check. All edges are therefore tried again with the
    // limit kReach, which is larger than the limit of regular levels.
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

struct CollapseMatcher::EdgeList {
  std::vector<KeyedIndex> edges;
  double lengths = 0;  // sum of the lengths of the edges
};

void CollapseMatcher::list_edges(const LevelRules& rules) {
  const std::span<const VertexId> live = surface_.live;
  std::vector<EdgeList> lists(live.size() / kListed + 1);
  for_each_index(threads_, lists.size(), [&](std::size_t i) {
    const auto rest = live.subspan(i * kListed);
    lists[i] = edges_at(rules, rest.first(std::min(kListed, rest.size())));
  });
  std::size_t size = 0;
  double lengths = 0;
  for (const EdgeList& list : lists)
    size += list.edges.size(), lengths += list.lengths;
  edges_.clear();
  edges_.reserve(size);
  for (EdgeList& list : lists) {
    edges_.insert(edges_.end(), list.edges.begin(), list.edges.end());
    list = {};
  }
  mean_edge_ = lengths / static_cast<double>(std::max<std::size_t>(size, 1));
}

CollapseMatcher::EdgeList CollapseMatcher::edges_at(const LevelRules& rules,
                                                    std::span<const VertexId> live) const {
  EdgeList list;
  list.edges.reserve(3 * live.size());
  const double lifted = rules.is_regular ? kLiftedRegular : kLifted;
  const Connectivity& mesh = surface_.mesh;
  for (VertexId v : live) {
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
        list.lengths += length(d);
        list.edges.push_back({cost_key(displayed + regular), c});
      }
      c = mesh.swing(c);
    } while (c != first);
  }
  return list;
}

// Estimates the merged position v~ much faster than merged_position(). The result is exact for
// midpoint placement. For pyramid placement, it is exact up to rounding. The rounding of midpoints
// must be included: of two edges that are otherwise equal, perhaps only one has a midpoint that
// rounds onto the surface.
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
  // `shared` counts the ring vertices that do not belong to `far`: the ring of each end contains
  // the other end and the m opposite vertices.
  const std::uint32_t both = ring_size_[v] + ring_size_[w], shared = 2 + 2 * m;
  if (m == 0 || both <= shared) return middle;
  const Vec3 far = ring_sum_[v] + ring_sum_[w] - p - q - near * 2;
  return middle + near * (1.0 / (4 * m)) - far * (1.0 / (4 * (both - shared)));
}

// Several threads check edges in advance, before the choice reaches these edges. The result does
// not depend on this, because a check reads only the mesh, which does not change here. A single
// thread instead checks each edge when the choice reaches it, which avoids checks of edges that are
// no longer available.
void CollapseMatcher::choose(const LevelRules& rules, std::span<const KeyedIndex> edges,
                             std::size_t enough) {
  const std::size_t most = threads_ == 1 ? 1 : kChecked;
  targets_.resize(most);
  while (!edges.empty()) {
    const auto next = edges.first(std::min(most, edges.size()));
    edges = edges.subspan(next.size());
    for_each_index(threads_, (next.size() - 1) / kCheckedAtOnce + 1, [&](std::size_t part) {
      const std::size_t begin = part * kCheckedAtOnce;
      for (std::size_t i = begin; i < std::min(begin + kCheckedAtOnce, next.size()); ++i)
        targets_[i] = check(rules, next[i].index);
    });
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (picks_.size() >= enough) return;
      if (targets_[i] && !is_taken(next[i].index)) take(rules, {next[i].index, *targets_[i]});
    }
  }
}

std::optional<Vec3i> CollapseMatcher::check(const LevelRules& rules, Corner c) const {
  if (is_taken(c)) return std::nullopt;
  const Connectivity& mesh = surface_.mesh;
  const EdgeStar edge(mesh, c);
  if (!keeps_manifold(mesh, edge)) return std::nullopt;
  const Vec3i target = merged_position(surface_, edge, rules.placement, rules.parity);
  if (!rules.allows(target) || !keeps_shape(edge, target)) return std::nullopt;
  return target;
}

void CollapseMatcher::take(const LevelRules& rules, const Pick& pick) {
  picks_.push_back(pick);
  for (const VertexId v :
       {surface_.mesh.vertex(pick.corner), surface_.mesh.neighbour(pick.corner)}) {
    is_taken_[v] = 1;
    withhold_neighbours(rules, v);
  }
}

void CollapseMatcher::withhold_neighbours(const LevelRules& rules, VertexId v) {
  const bool all = rules.placement == Placement::kPyramid;
  if (!all && !rules.keeps_regions) return;
  const Connectivity& mesh = surface_.mesh;
  const std::uint16_t own = surface_.region[v];
  const Corner first = mesh.corner_at(v);
  Corner c = first;
  do {
    const VertexId w = mesh.neighbour(c);
    if (!is_virtual(w) && (all || surface_.region[w] != own)) is_taken_[w] = 1;
    c = mesh.swing(c);
  } while (c != first);
}

}  // namespace vitrine::inline codec
