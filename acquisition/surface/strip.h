// SPDX-License-Identifier: Apache-2.0
// Triangulates the strip between two neighbouring steps.
#pragma once

#include <vector>

#include "acquisition/surface/cloud.h"

namespace vitrine::acquisition {

// Joins each strand of `step` to each strand of the next step. Among the paths down both strands,
// chooses the path with the most triangles. If several paths have the most, chooses the path with
// the shortest edges between strands; in a quad of equal rows this is the shorter diagonal. Strands
// may have any rows and numbers of points. A triangle needs all three edges. An edge along a strand
// exists unless its end is flagged kApart. An edge between strands exists if its points are closer
// than 4 s_max. Their rows may be far apart, because grazing surfaces extend over many rows. An
// edge between strands also exists if [WLL] eq. 5 joins its points and their rows are as close as
// those of the points around. In both cases, each point's strand must be nearest to the other
// point. An edge between strands bounds at most two triangles, of one pair of strands. An edge
// along a strand bounds at most one triangle on either side. No edge of the surface therefore has
// three faces.
void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces);

}  // namespace vitrine::acquisition
