// SPDX-License-Identifier: Apache-2.0
// The triangles between two neighbouring profiles.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine {

// Walks down both profiles at once. At each step the triangle with the shorter new edge across is
// taken (in a quad of equal rows: the shorter diagonal) if all three of its edges are accepted:
// along a profile where it is not kApart, across by eq. 5 and only between rows as close as the
// points around. So the profiles may have any rows and numbers of points. An edge across is of at
// most two triangles, an edge along a profile of at most one: the surface has no edge of three
// faces.
void add_strip(const Cloud& cloud, std::size_t profile, const Spacing& spacing,
               std::vector<Triangle>& faces);

}  // namespace vitrine
