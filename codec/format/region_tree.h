// SPDX-License-Identifier: Apache-2.0
// The tree of regions into which a model divides as it gets finer. The root is the whole model.
// From level `fork` on, a node is replaced by its two children. The regions of a level are the
// nodes that have not forked by that level but whose parents have. Leaves are numbered from left to
// right. A node covers a range of leaves; a region is identified by its first leaf.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The plane that divides a region. Vertices with coordinate[axis] < at go to the first child.
struct RegionPlane {
  std::uint8_t axis = 0;  // 0: x, 1: y, 2: z
  std::int32_t at = 0;    // lattice units

  bool is_beyond(const Vec3i& p) const { return (axis == 0 ? p.x : axis == 1 ? p.y : p.z) >= at; }
};

// An axis-aligned box in lattice units. Both corners belong to it.
struct LatticeBox {
  Vec3i low, high;

  bool operator==(const LatticeBox&) const = default;
  // Returns an empty box, to which others can be added.
  static constexpr LatticeBox none() {
    constexpr std::int32_t kFar = 1 << 18;
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  void add(const LatticeBox& o) {
    low = {std::min(low.x, o.low.x), std::min(low.y, o.low.y), std::min(low.z, o.low.z)};
    high = {std::max(high.x, o.high.x), std::max(high.y, o.high.y), std::max(high.z, o.high.z)};
  }
  bool holds(const Vec3i& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

struct RegionNode {
  std::uint32_t fork = 0;  // first level in which the children replace the node; 0 for a leaf
  RegionPlane plane;  // the plane that divides the vertices between the children; unused in a leaf
  LatticeBox box;     // bounds all faces at the region's vertices, in all levels

  // RegionTree::link() computes the members below.
  std::uint32_t second = 0;  // index of the second child; the first child follows the node
  std::uint32_t first = 0, leaves = 1;  // the first leaf under this node, and the number of leaves

  bool forks_by(std::uint32_t level) const { return fork != 0 && fork <= level; }
};

struct RegionTree {
  std::vector<RegionNode> nodes = std::vector<RegionNode>(1);  // in pre-order

  std::uint32_t leaves() const { return nodes[0].leaves; }

  // Computes `second`, `first` and `leaves` of each node from the fork levels. Returns false unless
  // the nodes form exactly one tree and no child forks at a coarser level than its parent.
  bool link();

  // Returns the nodes that are the regions of `level`, from left to right.
  std::vector<std::uint32_t> regions_at(std::uint32_t level) const;
};

}  // namespace vitrine::inline codec
