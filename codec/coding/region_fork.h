// SPDX-License-Identifier: Apache-2.0
// Codes how a region forks (divides into child regions) at the end of its last chunk: the child
// region of each vertex, in the order of vertex indices. The planes in the header that divide
// regions predict the child regions. Nearly all predictions are right, because regions are convex.
#pragma once

#include <utility>

#include "codec/coding/mesh_state.h"
#include "codec/core/range_coder.h"
#include "codec/format/region_tree.h"

namespace vitrine::inline codec {

// Divides the vertices of a node of `tree` among the regions of `level`. If a child of the node
// also forks in `level`, its vertices are divided again. The vertices of each region keep their
// order. Then updates the border flags of these vertices. `truth(v)` returns the leaf of v; only an
// encoder calls it.
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

}  // namespace vitrine::inline codec
