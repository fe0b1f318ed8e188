// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/cut_handles.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "codec/mesh/disjoint_sets.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kMostRoots = 60;
constexpr std::uint32_t kNoEdge = 0xFFFF'FFFFu;

struct Loop {
  double length = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> edges;
};

class HandleCutter {
 public:
  explicit HandleCutter(const Chart& chart) : chart_(chart), around_(chart.positions.size()) {
    for (std::uint32_t h = 0; h < 3 * chart.size(); ++h) {
      around_[start(h)].push_back(h);
      if (across(chart.edges, h) == h) around_[end(h)].push_back(h);
    }
    const auto loops = boundary_loops(chart.edges);
    dual_nodes_ = chart.size() + static_cast<std::uint32_t>(loops.size());
    dual_of_boundary_.resize(3 * chart.faces.size());
    for (std::uint32_t i = 0; i < loops.size(); ++i) {
      for (const std::uint32_t h : loops[i])
        dual_of_boundary_[h] = chart.size() + i;
    }
  }

  // Returns the edges of the shortest loop that does not divide the chart.
  std::vector<std::uint32_t> shortest_loop() {
    const auto wedges = static_cast<std::uint32_t>(chart_.positions.size());
    const std::uint32_t roots = std::min(wedges, kMostRoots);
    Loop best;
    for (std::uint32_t i = 0; i < roots; ++i) {
      grow_tree(static_cast<std::uint32_t>(std::uint64_t{wedges} * i / roots));
      find_loop(best);
    }
    return best.edges;
  }

 private:
  std::uint32_t start(std::uint32_t h) const { return chart_.wedges[h / 3][h % 3]; }
  std::uint32_t end(std::uint32_t h) const { return start(next_half_edge(h)); }
  std::uint32_t edge(std::uint32_t h) const { return std::min(h, across(chart_.edges, h)); }
  double edge_length(std::uint32_t h) const {
    return length(chart_.positions[end(h)] - chart_.positions[start(h)]);
  }

  // Grows the tree of shortest paths from wedge `root`, by Dijkstra's algorithm.
  void grow_tree(std::uint32_t root) {
    using Reached = std::pair<double, std::uint32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    distance_.assign(around_.size(), std::numeric_limits<double>::infinity());
    towards_root_.assign(around_.size(), kNoEdge);
    distance_[root] = 0;
    open.push({0, root});
    while (!open.empty()) {
      const auto [cost, from] = open.top();
      open.pop();
      if (cost > distance_[from]) continue;
      for (const std::uint32_t h : around_[from]) {
        const std::uint32_t to = start(h) == from ? end(h) : start(h);
        if (cost + edge_length(h) >= distance_[to]) continue;
        distance_[to] = cost + edge_length(h);
        towards_root_[to] = edge(h);
        open.push({distance_[to], to});
      }
    }
  }

  bool is_in_tree(std::uint32_t e) const {
    return towards_root_[start(e)] == e || towards_root_[end(e)] == e;
  }
  // Returns the length of the loop formed by edge e and the tree paths from its ends to the root.
  double loop_length(std::uint32_t e) const {
    return distance_[start(e)] + distance_[end(e)] + edge_length(e);
  }

  // Visits the edges outside the tree by descending loop length. An edge that joins two separate
  // parts of the dual graph belongs to the cotree. Any other edge closes a loop that does not
  // divide the surface. Keeps the shortest of these loops.
  void find_loop(Loop& best) const {
    std::vector<std::pair<double, std::uint32_t>> outside;
    for (std::uint32_t h = 0; h < 3 * chart_.size(); ++h) {
      if (edge(h) == h && !is_in_tree(h)) outside.emplace_back(-loop_length(h), h);
    }
    std::sort(outside.begin(), outside.end());
    DisjointSets dual(dual_nodes_);
    for (const auto& [negative, e] : outside) {
      const std::uint32_t other = across(chart_.edges, e);
      const std::uint32_t beyond = other == e ? dual_of_boundary_[e] : other / 3;
      if (!dual.join(e / 3, beyond) && -negative < best.length) best = {-negative, loop_of(e)};
    }
  }

  std::vector<std::uint32_t> loop_of(std::uint32_t e) const {
    std::vector<std::uint32_t> a = path(start(e)), b = path(end(e));
    while (!a.empty() && !b.empty() && a.back() == b.back())
      a.pop_back(), b.pop_back();
    a.insert(a.end(), b.begin(), b.end());
    a.push_back(e);
    return a;
  }
  std::vector<std::uint32_t> path(std::uint32_t wedge) const {
    std::vector<std::uint32_t> edges;
    for (std::uint32_t e; (e = towards_root_[wedge]) != kNoEdge; edges.push_back(e))
      wedge = start(e) == wedge ? end(e) : start(e);
    return edges;
  }

  const Chart& chart_;
  // For each wedge, one half-edge of each edge that ends at the wedge.
  std::vector<std::vector<std::uint32_t>> around_;
  std::uint32_t dual_nodes_;  // number of nodes of the dual graph: faces, then boundary loops
  // For each half-edge at a boundary, the dual node of its boundary loop.
  std::vector<std::uint32_t> dual_of_boundary_;
  std::vector<double> distance_;             // for each wedge, its distance from the root
  std::vector<std::uint32_t> towards_root_;  // for each wedge, the edge to its parent in the tree
};

bool is_connected(const Chart& chart) {
  const std::vector<std::uint32_t> same(chart.faces.size(), 0);
  const std::vector<std::uint32_t> set = connected_sets(chart.edges, same);
  return *std::max_element(set.begin(), set.end()) == 0;
}

}  // namespace

std::uint32_t doubled_genus(const Chart& chart) {
  std::uint32_t half_edges = 3 * chart.size();
  const auto loops = boundary_loops(chart.edges);
  for (const auto& loop : loops)
    half_edges += static_cast<std::uint32_t>(loop.size());
  const std::int64_t euler = static_cast<std::int64_t>(chart.positions.size()) - half_edges / 2 +
                             static_cast<std::int64_t>(chart.size());
  return static_cast<std::uint32_t>(2 - euler - static_cast<std::int64_t>(loops.size()));
}

bool cut_handles(const MeshView& mesh, Chart& chart) {
  while (doubled_genus(chart) > 0) {
    for (const std::uint32_t e : HandleCutter(chart).shortest_loop())
      cut(chart.edges, e);
    if (!is_connected(chart)) return false;
    find_wedges(mesh, chart);
  }
  return true;
}

}  // namespace vitrine::inline codec
