// SPDX-License-Identifier: Apache-2.0
// The order of a mesh in memory. Edges collapse by cost, all over the mesh: the work is mostly
// waiting for memory, unless what is near in space is near there, too.
#pragma once

#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

// Renumbers the vertices along a Z-order curve (Morton) and sorts the faces by their smallest
// vertex. Positions are finite, face indices in range.
void order_in_space(TriangleMesh& mesh);

}  // namespace vitrine
