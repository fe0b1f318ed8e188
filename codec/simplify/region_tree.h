// SPDX-License-Identifier: Apache-2.0
// Parts the vertices of the fine mesh into the leaves of a kd-tree, and joins these again as the
// mesh gets coarser.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/connectivity.h"
#include "codec/progressive/region_tree.h"

namespace vitrine {

struct RegionLabels {
  RegionTree tree;                  // the forks' levels are not known yet
  std::vector<std::uint16_t> leaf;  // per position
};

// A node of more than `capacity` (>= 1) vertices forks at the median along the longest side of
// their box, unless all are at one place. With capacities that ask for more than 32,768 leaves a
// larger one is taken.
RegionLabels label_regions(std::span<const Vec3i> positions, std::uint32_t capacity);

// Per leaf those that it shares an edge with, ascending.
std::vector<std::vector<std::uint32_t>> leaf_adjacency(std::span<const Triangle> faces,
                                                       const RegionLabels& labels);

// Follows the levels from fine to coarse.
class RegionJoiner {
 public:
  // `tree` outlives this.
  explicit RegionJoiner(RegionTree& tree) : tree_(tree), joined_(tree.nodes.size(), 0) {}

  // Before a level is collapsed: joins siblings that have at most `most` of the live vertices in
  // all. `region` names each live vertex' region and follows.
  void join(std::span<const VertexId> live, std::uint32_t most, std::vector<std::uint16_t>& region);

  bool is_whole() const { return is_region(0); }  // one region is left

  // Once all of `levels` are collapsed: enters the levels of the forks. False where the tree does
  // not fit the format: in the coarsest level the model must be one region.
  bool finish(std::uint32_t levels);

 private:
  bool is_region(std::uint32_t node) const {
    return tree_.nodes[node].fork == 0 || joined_[node] != 0;
  }

  RegionTree& tree_;
  std::vector<std::uint32_t> joined_;  // per node: how many calls of join() it took; 0: not yet
  std::uint32_t calls_ = 0;
};

}  // namespace vitrine
