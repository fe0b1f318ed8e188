// SPDX-License-Identifier: Apache-2.0
// The steps by which surface_of() makes a mesh of the profiles of a scan, in their order.
#pragma once

#include <cstdint>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/cloud.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

// Splits a profile into one strand, or two if a row has two points. Each strand is a profile of the
// same theta with at most one point per row. A single point in a row joins the strand whose last
// point is nearer. Two points in a row are assigned so that the sum of distances is least. A strand
// may change from one surface to the other, because strands only order the points.
std::vector<Profile> strands_of(const Profile& profile);

// Finds the points to drop: those on the far side of the table's axis that the scan also saw half a
// revolution earlier or later, from a better view. Returns one flag for each point: whether to keep
// the point. A point with negative rho is dropped if a point with positive rho is closer than
// `reach` mm, because the points of both views would form two sheets instead of one surface. Takes
// O(n log n) time.
std::vector<bool> first_views(const Cloud& cloud, double reach);

// Fills small gaps in a strand: interpolates points in missing rows, linearly in rho, lateral and
// z, and flags them kFilled. The two ends of a gap must be joined and at most `largest_hole` mm
// apart. Two points are joined by [WLL] eq. 5 or 6. On grazing surfaces, two points are also joined
// if the step between them resembles the step before or after. Flags a point kApart if it is not
// joined to the point before it or follows a larger gap. Returns the number of points added.
std::uint64_t fill_gaps(Profile& strand, double largest_hole, const Spacing& spacing);

// Smooths the scan: moves each point in rho onto a quadratic surface fitted to the rows and steps
// around the point. If a step has two strands, the fit uses the strand whose rho is nearer. The fit
// tries a few window sizes. It uses the largest window that is complete, whose rms residual is at
// most 1.5 times `noise` (mm), and that moves the point by at most 3 times `noise`. If no window
// qualifies, as at edges, the point does not move. Smoothing therefore removes no detail that is
// larger than the noise. `strands` are sorted by theta over one revolution, at equal steps, with
// points `spacing.rows` apart. Returns the number of points moved. Takes O(n) time.
std::uint64_t smooth(std::vector<Profile>& strands, double noise, const Spacing& spacing);

// Triangulates the strip between two neighbouring steps. Joins each strand of `step` to each strand
// of the next step. Strands may have any rows and numbers of points. Chooses the path down both
// strands that gives the most triangles. Among several such paths, chooses the path with the
// shortest edges between strands. In a quad of equal rows, this is the shorter diagonal. A triangle
// needs all three edges:
// - An edge along a strand exists unless its end is flagged kApart.
// - An edge between strands exists if its points are closer than 4 s_max. Their rows may be far
//   apart, because grazing surfaces extend over many rows.
// - An edge between strands also exists if [WLL] eq. 5 or 6 joins its points and their rows are as
//   close as the rows of neighbouring points.
// An edge between strands always needs two points whose strands are nearest to each other: no other
// strand of the same step is nearer. Such an edge bounds at most two triangles, both between the
// same two strands. An edge along a strand bounds at most one triangle on either side. No edge of
// the surface therefore has three faces.
void add_strips(const Cloud& cloud, std::size_t step, const Spacing& spacing,
                std::vector<Triangle>& faces);

// Closes each hole whose boundary loop fits into a box of `largest` mm, by a vertex in the middle
// and a fan of faces. The outer rim of a piece of surface is not a hole. No edge of `mesh` may have
// more than two faces. Returns the number of holes closed. Takes O(n log n) time.
std::uint64_t close_holes(TriangleMesh& mesh, double largest);

}  // namespace vitrine::acquisition
