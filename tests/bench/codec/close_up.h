// SPDX-License-Identifier: Apache-2.0
// Cameras close to a model, and the bytes that the planner sends to each camera.
#pragma once

#include <vector>

#include "codec/mesh/triangle_mesh.h"
#include "codec/plan/planner.h"

namespace vitrine::bench {

// Returns six cameras: one for each direction of each axis. Each camera is in front of the
// outermost vertex on its side. The camera is so close that `share` times the model's diagonal
// fills the height of a viewport of 800 x 600 pixels.
std::vector<View> close_ups(const TriangleMesh& mesh, double share);

// Returns the number of bytes, including the header, that are needed until no visible error exceeds
// one pixel.
std::uint64_t bytes_for(const Manifest& manifest, const View& view);

}  // namespace vitrine::bench
