// SPDX-License-Identifier: Apache-2.0
// Closes the small holes of a mesh.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

// Closes each hole whose boundary loop fits into a box of `largest` mm: adds a vertex in its middle
// and a fan of faces. Boundary loops around a piece of surface are not holes. No edge of `mesh` may
// have more than two faces. Returns the number of holes closed. O(n log n).
std::uint64_t close_holes(TriangleMesh& mesh, double largest);

}  // namespace vitrine::acquisition
