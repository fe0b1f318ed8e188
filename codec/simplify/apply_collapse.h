// SPDX-License-Identifier: Apache-2.0
// Performs an edge collapse. Returns the record that a vertex split needs to undo it.
#pragma once

#include "codec/format/hierarchy.h"
#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

struct Pick {
  Corner corner;  // corner of v1 in the face (v1, v2, apex12)
  Vec3i target;   // position of the merged vertex v~
};

// Collapses `edge`, which must be the edge at pick.corner and must pass keeps_manifold(). Moves v1
// to the merged position v~, adds v2's quadric to v1's, and merges the attributes of both vertices.
// Leaves `surface.live` unchanged.
Collapse apply_collapse(Surface& surface, const EdgeStar& edge, const Pick& pick);

}  // namespace vitrine::inline codec
