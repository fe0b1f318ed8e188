// SPDX-License-Identifier: Apache-2.0
// Closes the small holes of a mesh.
#pragma once

#include <cstdint>

#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

// Closes each hole whose boundary loop fits into a box of `largest` mm, by a vertex in the middle
// and a fan of faces. The outer rim of a piece of surface is not a hole. No edge of `mesh` may have
// more than two faces. Returns the number of holes closed. Takes O(n log n) time.
std::uint64_t close_holes(TriangleMesh& mesh, double largest);

}  // namespace vitrine::acquisition
