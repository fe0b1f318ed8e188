// SPDX-License-Identifier: Apache-2.0
// How far a collapse takes the surface from where it is. Quadrics do not tell: they know planes,
// not faces, so a needle that is cut, the rim of a thin wall, and a diagonal that turns cost
// nothing.
#pragma once

#include "codec/simplify/collapse_rules.h"
#include "codec/simplify/surface.h"

namespace vitrine {

// True if ends and middles of the edges that go stay within `reach` (lattice units) of the faces
// around v~, and middles of the edges and faces that come within `reach` of those that go.
bool keeps_near(const Surface& surface, const EdgeStar& edge, const Vec3i& target, double reach);

}  // namespace vitrine
