// SPDX-License-Identifier: Apache-2.0
// The order in which a chunk visits the vertices of its region: descending lexicographic order of
// position. Vertices at equal positions are visited in ascending order of index.
#pragma once

#include <span>
#include <vector>

#include "codec/coding/mesh_state.h"

namespace vitrine::inline codec {

std::vector<VertexId> visiting_order(const Segments<Vec3i>& positions,
                                     std::span<const VertexId> members);

}  // namespace vitrine::inline codec
