// SPDX-License-Identifier: Apache-2.0
// Sorts the vertices and faces of a mesh so that neighbours in space are also close in memory. The
// simplifier collapses edges all over the mesh. Without this order, waiting for memory would take
// most of its time.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

// Renumbers the vertices along a Z-order curve [Morton66] and sorts the faces by their smallest
// vertex. Positions must be finite and face indices in range. Returns for each face its index
// before the sort.
std::vector<std::uint32_t> order_in_space(TriangleMesh& mesh);

}  // namespace vitrine::inline codec
