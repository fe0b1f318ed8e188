// SPDX-License-Identifier: Apache-2.0
// The fork of a region: behind the splits of its last chunk each vertex, in the order of its
// index, says to which child it goes. The planes of the header nearly always say the same, because
// a region is convex.
#pragma once

#include <utility>

#include "codec/core/range_coder.h"
#include "codec/progressive/mesh_state.h"
#include "codec/progressive/region_tree.h"

namespace vitrine {

// Parts a node of `tree` into the regions of `level`, and those into their children where they
// fork there too. Members keep their order; then borders are marked. `truth(v)` is the leaf of v;
// read by an encoder only.
template <class Coder, class Truth>
void code_fork(MeshState& mesh, Coder& coder, const RegionTree& tree, std::uint32_t node,
               std::uint32_t level, const Truth& truth) {
  AdaptiveBit as_expected{.one = 65000, .seen = 8};
  const std::vector<VertexId> all = std::exchange(mesh.members[tree.nodes[node].first], {});
  for (const VertexId v : all) {
    std::uint32_t child = node;
    while (tree.nodes[child].forks_by(level)) {
      const RegionNode& parent = tree.nodes[child];
      const bool expected = parent.plane.is_beyond(mesh.positions[v]);
      const bool told = Coder::kEncodes && truth(v) >= tree.nodes[parent.second].first;
      const bool second = (coder.bit(as_expected, told == expected ? 1 : 0) != 0) == expected;
      child = second ? parent.second : child + 1;
    }
    mesh.vertex[v].region = static_cast<std::uint16_t>(tree.nodes[child].first);
    mesh.members[tree.nodes[child].first].push_back(v);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    mesh.fetch_rings(all, k);
    mesh.mark_border(all[k]);
  }
}

}  // namespace vitrine
