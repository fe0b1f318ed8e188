// SPDX-License-Identifier: Apache-2.0
// Performs and records a collapse that has been chosen.
#pragma once

#include "codec/progressive/hierarchy.h"
#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"

namespace vitrine {

struct Pick {
  Corner corner;  // of v1 in the face (v1, v2, apex12)
  Vec3i target;   // v~
};

// `edge` is the one at pick.corner, and legal. v1 moves to v~ and takes v2's quadric and half of
// its colour; `surface.live` stays as it is.
Collapse apply_collapse(Surface& surface, const EdgeStar& edge, const Pick& pick);

}  // namespace vitrine
