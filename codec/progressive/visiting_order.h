// SPDX-License-Identifier: Apache-2.0
// The order in which a chunk visits the vertices of its region: descending lexicographic order of
// their positions; vertices at the same place ascending.
#pragma once

#include <span>
#include <vector>

#include "codec/progressive/mesh_state.h"

namespace vitrine {

std::vector<VertexId> visiting_order(const Segments<Vec3i>& positions,
                                     std::span<const VertexId> members);

}  // namespace vitrine
