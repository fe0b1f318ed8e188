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
// the same two points with the same attributes. The ends of these two edges are then merged, unless
// one of the two faces is a copy or the reverse of the other. Coinciding vertices are not merged in
// three cases: their border edges do not coincide; they lie along an inner edge; or three or more
// border edges coincide.
//
// The remaining vertices keep their order. Returns the new index of each old vertex. Positions used
// by faces must be finite. Takes O(n log n) time.
std::vector<std::uint32_t> weld_seams(std::vector<Vec3>& positions, VertexAttributes& attributes,
                                      std::span<const Triangle> faces);

}  // namespace vitrine::inline codec
