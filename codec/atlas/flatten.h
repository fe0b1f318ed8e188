// SPDX-License-Identifier: Apache-2.0
// Flattens a chart: computes the positions of its wedges in the plane.
#pragma once

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Sets the chart's `uv`. Starts with the least squares conformal map, or with Tutte's embedding if
// that map flips a face. Then lowers the symmetric Dirichlet energy. The flat chart has the same
// area as in space. The chart must have a boundary and no handle; holes are allowed.
void flatten(Chart& chart);

}  // namespace vitrine::inline codec
