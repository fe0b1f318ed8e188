// SPDX-License-Identifier: Apache-2.0
// The display filter of coarse levels: p' = p + a n (n . (p - mean of the ring)), which takes back
// the shrinkage of midpoint placement for no bytes.
#pragma once

#include "codec/progressive/manifest.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// The shift of v for a = 1, lattice units. Vertices on a boundary stay where they are.
Vec3 display_shift(const MeshState& mesh, VertexId v);

// Where v is displayed, lattice units. `at` is the level that v has reached. Vertices next to
// another region stay, so that what a region shows does not depend on how far its neighbours are.
Vec3 display_position(const MeshState& mesh, VertexId v, const LevelInfo& at);

}  // namespace vitrine
