// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/mesh_state.h"

namespace vitrine {

void MeshState::inherit(VertexId v) {
  const std::uint16_t k = region[v];
  const VertexId w = vertex_count();
  positions.push_back(positions[v]);
  if (!colours.empty()) colours.push_back(colours[v]);
  region.push_back(k);
  index.push_back(static_cast<std::uint32_t>(members[k].size()));
  members[k].push_back(w);
  split_level.push_back(split_level[v]);
  visited_level.push_back(visited_level[v]);
  border.push_back(border[v]);
  valence.push_back(0);
  split_of.push_back(split_of[v]);
}

void MeshState::mark_border(VertexId v) {
  const Corner first = connectivity.corner_at(v);
  border[v] = 0;
  Corner c = first;
  do {
    const VertexId q = connectivity.vertex(next(c));
    if (!is_virtual(q) && region[q] != region[v]) border[v] = 1;
    c = connectivity.swing(c);
  } while (c != first);
}

}  // namespace vitrine
