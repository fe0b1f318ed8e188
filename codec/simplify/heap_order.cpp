// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/heap_order.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

#include "codec/simplify/apply_collapse.h"

namespace vitrine::inline codec {
namespace {

struct EdgeCost {
  double cost;
  VertexId a, b;        // a < b
  std::uint32_t stamp;  // stamp_[a] + stamp_[b] when the cost was computed

  // Compares in reverse, because std::priority_queue pops the largest element first.
  bool operator<(const EdgeCost& o) const {
    return std::tie(o.cost, o.a, o.b) < std::tie(cost, a, b);
  }
};

// Computes the level of each collapse. A collapse reads all vertices of the one-rings of v1 and v2,
// and changes v1 and v2.
class Dependencies {
 public:
  explicit Dependencies(std::size_t vertices) : changed_(vertices), met_(vertices) {}

  // Returns the finest level to which the collapse can be added. Levels are numbered from 1, which
  // is the finest.
  std::uint32_t level_of(const EdgeStar& edge) const {
    std::uint32_t last = std::max(met_[edge.v1], met_[edge.v2]);
    for_each_met(edge, [&](VertexId v) { last = std::max(last, changed_[v]); });
    return last + 1;
  }

  void enter(const EdgeStar& edge, std::uint32_t level) {
    for_each_met(edge, [&](VertexId v) { met_[v] = std::max(met_[v], level); });
    changed_[edge.v1] = changed_[edge.v2] = level;
  }

 private:
  template <class Visit>
  static void for_each_met(const EdgeStar& edge, const Visit& visit) {
    for (const Star* star : {&edge.star1, &edge.star2}) {
      for (VertexId v : star->neighbours()) {
        if (!is_virtual(v)) visit(v);  // v1 and v2 are visited, too, as neighbours of each other
      }
    }
  }

  std::vector<std::uint32_t> changed_, met_;
};

class HeapOrder {
 public:
  HeapOrder(Surface& surface, const LevelRules& rules, std::uint32_t most_levels)
      : surface_(surface),
        rules_(rules),
        depends_(surface.position.size()),
        stamp_(surface.position.size()),
        most_levels_(most_levels) {}

  std::vector<CollapseLevel> run(std::uint32_t target_vertices) {
    std::size_t left = surface_.live.size();
    // An edge that was refused may become legal later. The loop therefore repeats until a pass
    // collapses no edge.
    for (std::size_t before = left + 1; left > target_vertices && left < before;) {
      before = left;
      push_all();
      left = empty_heap(left, target_vertices);
    }
    std::erase_if(surface_.live,
                  [&](VertexId v) { return surface_.mesh.corner_at(v) == kNoCorner; });
    return grouped();
  }

 private:
  void push_all() {
    for (VertexId v : surface_.live) {
      if (surface_.mesh.corner_at(v) != kNoCorner) push_around(v, true);
    }
  }

  void push_around(VertexId v, bool once) {
    const Star star(surface_.mesh, v);
    for (std::uint32_t i = 0; i < star.valence; ++i) {
      const VertexId w = star.vertex[i];
      if (is_virtual(w) || (once && w < v)) continue;
      const EdgeStar edge(surface_.mesh, star.corner[i]);
      if (edge.star2.valence == 0) continue;
      const Vec3i target = merged_position(surface_, edge, rules_.placement, 0);
      const Vec3 at = surface_.middle(target);
      const double cost = surface_.quadric[v].at(at) + surface_.quadric[w].at(at);
      heap_.push({cost, std::min(v, w), std::max(v, w), stamp_[v] + stamp_[w]});
    }
  }

  std::size_t empty_heap(std::size_t left, std::uint32_t target_vertices) {
    while (!heap_.empty() && left > target_vertices) {
      const EdgeCost pair = heap_.top();
      heap_.pop();
      const bool current = surface_.mesh.corner_at(pair.a) != kNoCorner &&
                           surface_.mesh.corner_at(pair.b) != kNoCorner &&
                           pair.stamp == stamp_[pair.a] + stamp_[pair.b];
      if (current && collapse(pair)) --left;
    }
    heap_ = {};
    return left;
  }

  Corner corner_towards(VertexId v, VertexId w) const {
    const Star star(surface_.mesh, v);
    const auto neighbours = star.neighbours();
    const auto at = std::find(neighbours.begin(), neighbours.end(), w) - neighbours.begin();
    return at < static_cast<std::ptrdiff_t>(star.valence)
               ? star.corner[static_cast<std::size_t>(at)]
               : kNoCorner;
  }

  bool collapse(const EdgeCost& pair) {
    const Corner corner = corner_towards(pair.a, pair.b);
    if (corner == kNoCorner) return false;
    const EdgeStar edge(surface_.mesh, corner);
    if (!keeps_manifold(surface_.mesh, edge)) return false;
    std::uint32_t level = depends_.level_of(edge);
    Vec3i target = target_in(level, edge);
    while (level <= levels_.size() && levels_[level - 1].contains(target))
      target = target_in(++level, edge);
    if (level > most_levels_ || !rules_.allows(target)) return false;
    if (!keeps_orientation(surface_, edge, target)) return false;

    depends_.enter(edge, level);
    levels_.resize(std::max<std::size_t>(levels_.size(), level));
    levels_[level - 1].emplace(target, apply_collapse(surface_, edge, {corner, target}));
    ++stamp_[edge.v1];
    push_around(edge.v1, false);
    return true;
  }

  Vec3i target_in(std::uint32_t level, const EdgeStar& edge) const {
    const auto parity = static_cast<std::int32_t>((level - 1) & 1);
    return merged_position(surface_, edge, rules_.placement, parity);
  }

  std::vector<CollapseLevel> grouped() const {
    std::vector<CollapseLevel> out;
    for (const auto& level : levels_) {
      out.emplace_back();
      for (const auto& [target, collapse] : level)
        out.back().push_back(collapse);
    }
    return out;
  }

  Surface& surface_;
  const LevelRules& rules_;
  Dependencies depends_;
  std::vector<std::uint32_t> stamp_;  // per vertex: number of times the vertex has moved
  std::uint32_t most_levels_;
  std::priority_queue<EdgeCost> heap_;
  // Collapses of each level, sorted by the position of the merged vertex.
  std::vector<std::map<Vec3i, Collapse>> levels_;
};

}  // namespace

std::vector<CollapseLevel> collapse_by_heap(Surface& surface, const LevelRules& rules,
                                            std::uint32_t target_vertices,
                                            std::uint32_t most_levels) {
  return HeapOrder(surface, rules, most_levels).run(target_vertices);
}

}  // namespace vitrine::inline codec
