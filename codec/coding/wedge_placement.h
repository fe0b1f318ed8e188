// SPDX-License-Identifier: Apache-2.0
// Computes the texture coordinates of the two vertices of a split. Both encoder and decoder predict
// them in the same way, so no data is coded.
//
// Directly after a split, place_wedges() moves the coordinates of its two vertices apart, so that
// every triangle in the picture keeps its orientation. Once all splits of the chunk have their
// exact positions, relax_wedges() improves the triangles' shapes. Both functions use only vertices
// of the chunk's region and vertices that do not split in the same level. The result therefore does
// not depend on the order in which regions are refined.
#pragma once

#include "codec/coding/mesh_state.h"
#include "codec/coding/surroundings.h"

namespace vitrine::inline codec {

// Places the wedges of v and w after v was split into v and w. The positions of both vertices are
// still estimates; `merged` is the position of v before the split.
void place_wedges(MeshState& mesh, VertexId v, VertexId w, const Vec3i& merged);

// Moves the wedges of all vertices that the chunk has split.
void relax_wedges(MeshState& mesh, const ChunkSplits& chunk);

}  // namespace vitrine::inline codec
