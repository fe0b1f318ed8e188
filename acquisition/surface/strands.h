// SPDX-License-Identifier: Apache-2.0
// Splits a profile whose rows show two surfaces into strands with one point per row.
#pragma once

#include <vector>

#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

// Splits a profile into one strand, or two if a row has two points. Each strand is a profile of the
// same theta with at most one point per row. A single point in a row joins the strand whose last
// point is nearer. Two points in a row are assigned so that the sum of distances is least. A strand
// may change from one surface to the other, because strands only order the points.
std::vector<Profile> strands_of(const Profile& profile);

}  // namespace vitrine::acquisition
