// SPDX-License-Identifier: Apache-2.0
// Checks that a collapse keeps the surface close to its previous state. Quadrics cannot check this,
// because they measure distances to planes, not to faces. A quadric sees no error in a collapse
// that shortens a needle, erodes the rim of a thin wall or swaps a diagonal.
#pragma once

#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

// Whether the surfaces before and after a collapse are close to each other, within `reach` (lattice
// units). Measures from the ends and midpoints of the removed edges to the new faces around v~, and
// from the midpoints of the new edges and the centroids of the new faces to the removed faces.
bool keeps_near(const Surface& surface, const EdgeStar& edge, const Vec3i& target, double reach);

}  // namespace vitrine::inline codec
