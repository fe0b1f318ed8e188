// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/apply_collapse.h"

namespace vitrine::inline codec {

Collapse apply_collapse(Surface& surface, const EdgeStar& edge, const Pick& pick) {
  const auto [v1, v2] = std::pair(edge.v1, edge.v2);
  Collapse done{.v1 = v1,
                .v2 = v2,
                .apex12 = edge.apex12,
                .apex21 = edge.apex21,
                .p1 = surface.position[v1],
                .p2 = surface.position[v2],
                .a1 = {},
                .a2 = {}};
  surface.mesh.collapse(pick.corner);
  surface.position[v1] = pick.target;
  surface.quadric[v1] += surface.quadric[v2];
  for (std::size_t i = 0; i < surface.attributes.size(); ++i) {
    std::vector<Vec3i>& values = surface.attributes[i].values;
    done.a1[i] = values[v1], done.a2[i] = values[v2];
    values[v1] = merge_values(done.a1[i], done.a2[i]);
  }
  return done;
}

}  // namespace vitrine::inline codec
