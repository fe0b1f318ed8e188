// SPDX-License-Identifier: Apache-2.0
// The display filter of coarse levels. It displays the point p at p' = p + a n (n . (p - m)). n is
// the vertex normal, and m is the mean position of the adjacent vertices. The filter undoes the
// shrinkage of midpoint placement. It needs only one coded number per level, `a`.
#pragma once

#include "codec/coding/mesh_state.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Returns the displacement of v at filter strength a = 1, in lattice units. Returns zero if v is on
// a boundary.
Vec3 display_shift(const MeshState& mesh, VertexId v);

// Returns the displayed position of v in lattice units. `at` describes the level of v's region. If
// v is adjacent to another region, the filter is not applied. The display of a region therefore
// does not depend on the levels of its neighbours.
Vec3 display_position(const MeshState& mesh, VertexId v, const LevelInfo& at);

}  // namespace vitrine::inline codec
