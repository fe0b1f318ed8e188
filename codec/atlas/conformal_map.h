// SPDX-License-Identifier: Apache-2.0
// Computes the least squares conformal map of a chart ([LPRM02] section 2).
#pragma once

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Returns the position of each wedge in the plane. Two boundary wedges that are far apart are
// pinned: their distance in the plane equals their distance in space. Faces may be flipped. The
// chart must have a boundary.
std::vector<Vec2> conformal_map(const Chart& chart);

}  // namespace vitrine::inline codec
