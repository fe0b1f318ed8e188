// SPDX-License-Identifier: Apache-2.0
// The tree of regions into which a model parts as it gets finer. The whole model is the root. From
// level `fork` on the two children of a node take its place, so every level has regions of its own:
// the nodes that have not forked by then and whose parent has. The leaves are numbered from left
// to right; a node is the range of its leaves, and a region is named by its first leaf.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Vertices with coordinate[axis] < at go to the first child.
struct RegionPlane {
  std::uint8_t axis = 0;  // 0 x, 1 y, 2 z
  std::int32_t at = 0;    // lattice units

  bool is_beyond(const Vec3i& p) const { return (axis == 0 ? p.x : axis == 1 ? p.y : p.z) >= at; }
};

// Inclusive; lattice units.
struct LatticeBox {
  Vec3i low, high;

  bool operator==(const LatticeBox&) const = default;
  // Holds nothing, until something is added.
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
  std::uint32_t fork = 0;  // the first level in which its children take its place; 0: a leaf
  RegionPlane plane;       // of a fork
  LatticeBox box;          // of all faces at its vertices in all levels, as coded

  // Filled by RegionTree::link().
  std::uint32_t second = 0;             // the node of its second child; the first is the next one
  std::uint32_t first = 0, leaves = 1;  // its leaves

  bool forks_by(std::uint32_t level) const { return fork != 0 && fork <= level; }
};

struct RegionTree {
  std::vector<RegionNode> nodes = std::vector<RegionNode>(1);  // in pre-order

  std::uint32_t leaves() const { return nodes[0].leaves; }

  // Fills in what follows from the forks. False unless they make exactly one tree in which no
  // child forks at a coarser level than its parent.
  bool link();

  // The regions of a level: nodes from left to right.
  std::vector<std::uint32_t> regions_at(std::uint32_t level) const;
};

}  // namespace vitrine
