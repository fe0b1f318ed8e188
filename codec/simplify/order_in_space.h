// SPDX-License-Identifier: Apache-2.0
// Sorts the vertices and faces of a mesh so that neighbours in space are close in memory, too. The
// simplifier collapses edges by cost, all over the mesh, so memory latency would dominate
// otherwise.
#pragma once

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Renumbers the vertices along a Z-order curve [Morton66] and sorts the faces by their smallest
// vertex. Positions must be finite and face indices in range.
void order_in_space(TriangleMesh& mesh);

}  // namespace vitrine::inline codec
