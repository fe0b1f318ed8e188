// SPDX-License-Identifier: Apache-2.0
// The display filter of coarse levels (DESIGN section 2): p' = p - a n (n . (p - mean of the
// ring)), which takes back the shrinkage of midpoint placement for no bytes.
#pragma once

#include <functional>
#include <vector>

#include "codec/progressive/mesh_state.h"

namespace vitrine {

// One filtered position per vertex, lattice units. `strength(v)` is `a` at v. Vertices on a
// boundary stay where they are.
void filter_for_display(const MeshState& mesh, const std::function<double(VertexId)>& strength,
                        std::vector<Vec3>& out);

}  // namespace vitrine
