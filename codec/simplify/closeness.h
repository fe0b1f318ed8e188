// SPDX-License-Identifier: Apache-2.0
// Checks that a collapse keeps the surface close to its previous shape. Quadrics cannot check this,
// because they measure distances to planes, not to faces. For a quadric, a collapse has no error if
// it shortens a needle, erodes the rim of a thin wall or swaps a diagonal.
#pragma once

#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

// Whether the surfaces before and after a collapse are within `reach` of each other, in lattice
// units. The distances are measured at sample points. On the old surface, these are the ends and
// midpoints of the removed edges. On the new surface, these are the midpoints of the new edges and
// the centroids of the new faces.
bool keeps_near(const Surface& surface, const EdgeStar& edge, const Vec3i& target, double reach);

}  // namespace vitrine::inline codec
