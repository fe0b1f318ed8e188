// SPDX-License-Identifier: Apache-2.0
// The tree of regions. A model divides into more regions as its levels get finer. The root is the
// whole model. From level `fork` on, a node's two children replace the node. The regions of a level
// are the nodes that have not forked yet, but whose parents have. Leaves are numbered from left to
// right. A node covers a range of leaves. A region is identified by its first leaf.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// The plane that divides a region. Vertices with coordinate[axis] < at go to the first child.
struct RegionPlane {
  std::uint8_t axis = 0;  // 0: x, 1: y, 2: z
  std::int32_t at = 0;    // position of the plane on the axis, in lattice units

  bool is_beyond(const Vec3i& p) const { return (axis == 0 ? p.x : axis == 1 ? p.y : p.z) >= at; }
};

// An axis-aligned box in lattice units. It includes both corners.
struct LatticeBox {
  Vec3i low, high;

  bool operator==(const LatticeBox&) const = default;
  // Returns an empty box, to which points and boxes can be added.
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
  std::uint32_t fork = 0;  // first level in which the children replace this node; 0 for a leaf
  RegionPlane plane;       // divides the vertices between the children; unused in a leaf
  LatticeBox box;          // contains all faces at the region's vertices, in all levels

  // RegionTree::link() sets the members below.
  std::uint32_t second = 0;  // index of the second child; the first child is the next node
  std::uint32_t first = 0, leaves = 1;  // first leaf under this node, and number of leaves

  bool forks_by(std::uint32_t level) const { return fork != 0 && fork <= level; }
};

struct RegionTree {
  std::vector<RegionNode> nodes = std::vector<RegionNode>(1);  // in pre-order

  std::uint32_t leaves() const { return nodes[0].leaves; }

  // Computes `second`, `first` and `leaves` of each node from the fork levels. Returns false if the
  // nodes do not form exactly one tree, or if a child forks at a coarser level than its parent.
  bool link();

  // Returns the nodes that are regions in `level`, from left to right.
  std::vector<std::uint32_t> regions_at(std::uint32_t level) const;
};

}  // namespace vitrine::inline codec
