// SPDX-License-Identifier: Apache-2.0
// Computes Tutte's embedding of a chart ([Tutte63], and [Floater97] with equal weights). The
// longest boundary loop maps to a circle. Every other wedge maps to the mean of its neighbours.
#pragma once

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Returns the position of each wedge in the plane. Faces of a disc are never flipped, apart from
// rounding errors. Holes of the chart are treated as filled. The chart must have a boundary and no
// handle.
std::vector<Vec2> tutte_embedding(const Chart& chart);

}  // namespace vitrine::inline codec
