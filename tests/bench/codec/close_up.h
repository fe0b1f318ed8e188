// SPDX-License-Identifier: Apache-2.0
// Cameras that stand close to a model, and what the planner sends them.
#pragma once

#include <vector>

#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/planner.h"

namespace vitrine::bench {

// One from each of six sides: before the vertex that is farthest out, as near as a `share` of the
// model's diagonal fills the height of a viewport of 800 x 600.
std::vector<View> close_ups(const TriangleMesh& mesh, double share);

// Bytes that a visitor has fetched once no error in sight is above one pixel, head included.
std::uint64_t bytes_for(const Manifest& manifest, const View& view);

}  // namespace vitrine::bench
