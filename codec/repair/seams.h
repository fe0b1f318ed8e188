// SPDX-License-Identifier: Apache-2.0
// Closes seams. A seam is a border along which a file repeats its vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// Merges the vertices that are repeated along seams. Two border edges lie on a seam if they join
// the same two points with the same attributes. Their ends are then merged, unless one of the two
// faces is a copy or the reverse of the other. Vertices are not merged if only they coincide, but
// not their border edges; if they lie along an inner edge; or if three or more border edges
// coincide.
//
// The remaining vertices keep their order. Returns the new index of each old vertex. Positions used
// by faces must be finite. Takes O(n log n) time.
std::vector<std::uint32_t> weld_seams(std::vector<Vec3>& positions, VertexAttributes& attributes,
                                      std::span<const Triangle> faces);

}  // namespace vitrine::inline codec
