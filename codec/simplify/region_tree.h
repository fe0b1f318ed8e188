// SPDX-License-Identifier: Apache-2.0
// Divides the vertices of the fine mesh among the leaves of a kd-tree. As the mesh gets coarser,
// joins leaves into larger regions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/format/region_tree.h"
#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {

struct RegionLabels {
  RegionTree tree;                  // RegionJoiner::finish() sets the fork levels
  std::vector<std::uint16_t> leaf;  // per position: index of its leaf
};

// Assigns each position to a leaf. A node with more than `capacity` (>= 1) vertices forks at the
// median along the longest side of its bounding box, unless all its vertices coincide. `capacity`
// is raised if it would give more than 32,768 leaves.
RegionLabels label_regions(std::span<const Vec3i> positions, std::uint32_t capacity);

// Returns, for each leaf, the leaves that share an edge with it, in ascending order.
std::vector<std::vector<std::uint32_t>> leaf_adjacency(std::span<const Triangle> faces,
                                                       const RegionLabels& labels);

// Joins regions level by level, from fine to coarse.
class RegionJoiner {
 public:
  // `tree` must outlive this object.
  explicit RegionJoiner(RegionTree& tree) : tree_(tree), joined_(tree.nodes.size(), 0) {}

  // Joins sibling regions if they have at most `most` live vertices together. Call this before the
  // collapses of each level. `region` holds the region of each vertex and is updated.
  void join(std::span<const VertexId> live, std::uint32_t most, std::vector<std::uint16_t>& region);

  bool is_whole() const { return is_region(0); }  // whether only one region is left

  // Sets the fork levels. Call this once, after all `levels` levels have been collapsed. Returns
  // false if the coarsest level has more than one region, because the format does not allow this.
  bool finish(std::uint32_t levels);

 private:
  bool is_region(std::uint32_t node) const {
    return tree_.nodes[node].fork == 0 || joined_[node] != 0;
  }

  RegionTree& tree_;
  // Per node: number of the join() call, from 1, that joined the node's children; 0 if none did.
  std::vector<std::uint32_t> joined_;
  std::uint32_t calls_ = 0;
};

}  // namespace vitrine::inline codec
