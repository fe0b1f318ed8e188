// SPDX-License-Identifier: Apache-2.0
// Moves coincident points of a mesh apart, so that every edge has a length above zero.
#pragma once

#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Returns the new positions. If an edge is shorter than a thousandth of the mean edge, both its
// ends move by up to a hundredth of the mean edge. The direction of a move depends on the vertex's
// index.
std::vector<Vec3> spread_points(std::span<const Vec3> positions, std::span<const Triangle> faces);

}  // namespace vitrine::inline codec
