// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/apply_collapse.h"

#include "codec/progressive/colour.h"

namespace vitrine {

Collapse apply_collapse(Surface& surface, const EdgeStar& edge, const Pick& pick) {
  const auto [v1, v2] = std::pair(edge.v1, edge.v2);
  Collapse done{.v1 = v1,
                .v2 = v2,
                .apex12 = edge.apex12,
                .apex21 = edge.apex21,
                .p1 = surface.position[v1],
                .p2 = surface.position[v2],
                .c1 = {},
                .c2 = {}};
  surface.mesh.collapse(pick.corner);
  surface.position[v1] = pick.target;
  surface.quadric[v1] += surface.quadric[v2];
  if (!surface.colour.empty()) {
    done.c1 = surface.colour[v1], done.c2 = surface.colour[v2];
    surface.colour[v1] = merge_colours(done.c1, done.c2);
  }
  return done;
}

}  // namespace vitrine
