// SPDX-License-Identifier: Apache-2.0
// The display filter of coarse levels: p' = p + a n (n . (p - mean of the ring)), where n is the
// vertex normal. It undoes the shrinkage of midpoint placement and needs no coded data.
#pragma once

#include "codec/coding/mesh_state.h"
#include "codec/format/manifest.h"

namespace vitrine::inline codec {

// Returns the displacement of v for a = 1, in lattice units. It is zero for vertices on a boundary.
Vec3 display_shift(const MeshState& mesh, VertexId v);

// Returns the displayed position of v in lattice units. `at` describes the level that v has
// reached. Vertices adjacent to another region are not filtered, so that the display of a region
// does not depend on the levels of its neighbours.
Vec3 display_position(const MeshState& mesh, VertexId v, const LevelInfo& at);

}  // namespace vitrine::inline codec
