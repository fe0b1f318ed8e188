// SPDX-License-Identifier: Apache-2.0
// Closes the small holes of a mesh.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

// Each loop of boundary edges that goes round a hole (not round a piece of surface) and fits into a
// box of `largest` mm gets a new vertex in its middle and a fan of faces around it. `mesh` has no
// edge with more than two faces. Returns how many were closed. O(n log n).
std::uint64_t close_holes(TriangleMesh& mesh, double largest);

}  // namespace vitrine
