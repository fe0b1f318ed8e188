// SPDX-License-Identifier: Apache-2.0
// The triangles between two neighbouring steps.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// Of all pairs of strands, one of `step` and one of the next. Of the ways down both strands at once
// the one is taken that makes the most triangles, and of those the one with the shortest edges
// across (in a quad of equal rows: the shorter diagonal). A triangle needs all three of its edges:
// along a strand where it is not kApart; across where the points are closer than 4 s_max, whatever
// their rows (a shelf that laser or camera graze goes over many rows from step to step, and far in
// depth at each), or else by eq. 5 between rows as close as the points around; and only where of
// the other step's strands each of the two points has the other's nearest. So the strands may have
// any rows and numbers of points. An edge across is of at most two triangles of one pair of
// strands, an edge along a strand of at most one triangle on either side: the surface has no edge
// of three faces.
void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces);

}  // namespace vitrine
