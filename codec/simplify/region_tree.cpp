// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/region_tree.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kMostLeaves = 32'768;
constexpr std::uint32_t kSomeFork = 1;  // marks a node that forks; its level is computed later

std::int32_t coordinate(const Vec3i& p, std::uint8_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

class RegionTreeBuilder {
 public:
  RegionTreeBuilder(std::span<const Vec3i> positions, std::uint32_t capacity, RegionLabels& labels)
      : positions_(positions), capacity_(capacity), labels_(labels) {}

  void build(std::span<std::uint32_t> vertices) {
    RegionNode node;
    if (vertices.size() > capacity_ && choose(vertices, node.plane)) node.fork = kSomeFork;
    labels_.tree.nodes.push_back(node);
    if (node.fork == 0) {
      for (const std::uint32_t v : vertices)
        labels_.leaf[v] = next_leaf_;
      ++next_leaf_;
      return;
    }
    const auto middle = std::partition(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
      return !node.plane.is_beyond(positions_[v]);
    });
    const auto first = static_cast<std::size_t>(middle - vertices.begin());
    build(vertices.first(first));
    build(vertices.subspan(first));
  }

 private:
  // Chooses the plane that divides `vertices` at the median along the longest side of their
  // bounding box. Returns false if all vertices coincide.
  bool choose(std::span<std::uint32_t> vertices, RegionPlane& plane) const {
    Vec3i low = positions_[vertices[0]], high = low;
    for (const std::uint32_t v : vertices) {
      const Vec3i& p = positions_[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    if (low == high) return false;
    const Vec3i side = high - low;
    plane.axis = side.y >= side.z ? 1 : 2;
    if (side.x >= side.y && side.x >= side.z) plane.axis = 0;
    const auto nth = vertices.begin() + static_cast<std::ptrdiff_t>(vertices.size() / 2);
    std::nth_element(vertices.begin(), nth, vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
      return coordinate(positions_[a], plane.axis) < coordinate(positions_[b], plane.axis);
    });
    plane.at = std::max(coordinate(positions_[*nth], plane.axis), coordinate(low, plane.axis) + 1);
    return true;
  }

  std::span<const Vec3i> positions_;
  std::uint32_t capacity_;
  RegionLabels& labels_;
  std::uint16_t next_leaf_ = 0;
};

}  // namespace

RegionLabels label_regions(std::span<const Vec3i> positions, std::uint32_t capacity) {
  const auto count = static_cast<std::uint32_t>(positions.size());
  RegionLabels labels;
  labels.tree.nodes.clear();
  labels.leaf.resize(count);
  std::vector<std::uint32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), 0u);
  // Each fork halves the number of vertices. A leaf therefore has at least about half the capacity,
  // unless many vertices coincide. The capacity is raised such that about kMostLeaves leaves
  // suffice.
  RegionTreeBuilder(positions, std::max(capacity, count / (kMostLeaves / 2)), labels)
      .build(vertices);
  labels.tree.link();
  return labels;
}

std::vector<std::vector<std::uint32_t>> leaf_adjacency(std::span<const Triangle> faces,
                                                       const RegionLabels& labels) {
  std::vector<std::set<std::uint32_t>> sets(labels.tree.leaves());
  for (const Triangle& t : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t a = labels.leaf[t[k]], b = labels.leaf[t[(k + 1) % 3]];
      if (a != b) sets[a].insert(b), sets[b].insert(a);
    }
  }
  std::vector<std::vector<std::uint32_t>> adjacency;
  adjacency.reserve(sets.size());
  for (const auto& set : sets)
    adjacency.emplace_back(set.begin(), set.end());
  return adjacency;
}

void RegionJoiner::join(std::span<const VertexId> live, std::uint32_t most,
                        std::vector<std::uint16_t>& region) {
  ++calls_;
  std::vector<std::uint32_t> in_region(tree_.leaves()), in_node(tree_.nodes.size());
  for (const VertexId v : live)
    ++in_region[region[v]];
  std::vector<std::uint16_t> name(tree_.leaves());
  for (auto i = static_cast<std::uint32_t>(tree_.nodes.size()); i-- > 0;) {
    const RegionNode& node = tree_.nodes[i];
    if (is_region(i)) {
      in_node[i] = in_region[node.first];
    } else {
      in_node[i] = in_node[i + 1] + in_node[node.second];
      const bool joins = is_region(i + 1) && is_region(node.second) && in_node[i] <= most;
      if (joins) joined_[i] = calls_;
    }
    if (!is_region(i)) continue;
    // Nodes are visited from the leaves to the root. Each leaf therefore ends up with the number of
    // the largest region that contains the leaf.
    std::fill_n(name.begin() + node.first, node.leaves, static_cast<std::uint16_t>(node.first));
  }
  for (const VertexId v : live)
    region[v] = name[region[v]];
}

bool RegionJoiner::finish(std::uint32_t levels) {
  for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
    RegionNode& node = tree_.nodes[i];
    if (node.fork == 0) continue;
    // Call number n of join() came before the collapses of level `levels` + 1 - n.
    if (joined_[i] == 0 || joined_[i] > levels) return false;
    node.fork = levels + 2 - joined_[i];
  }
  return tree_.link();
}

}  // namespace vitrine::inline codec
