// SPDX-License-Identifier: Apache-2.0
// The triangles between two neighbouring steps.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// Of all pairs of strands, one of `step` and one of the next. Walks down both strands at once. At
// each step the triangle with the shorter new edge across is taken (in a quad of equal rows: the
// shorter diagonal) if all three of its edges are accepted: along a strand where it is not kApart,
// across by eq. 5, only between rows as close as the points around, and only where of the other
// step's strands each of the two points has the other's nearest. So the strands may have any rows
// and numbers of points. An edge across is of at most two triangles of one pair of strands, an edge
// along a strand of at most one triangle on either side: the surface has no edge of three faces.
void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces);

}  // namespace vitrine
