// SPDX-License-Identifier: Apache-2.0
// Parts a profile whose rows show two surfaces into strands that show one a row.
#pragma once

#include <vector>

#include "acquisition/profile/profile.h"

namespace vitrine {

// One strand, or two where a row has two points: each a profile of the same theta with at most one
// point a row. A point goes on with the strand whose last point is the nearer one, and of two in a
// row both so that they lie nearest in sum. Each strand may go over from one surface to another: it
// is only a way to order the points.
std::vector<Profile> strands_of(const Profile& profile);

}  // namespace vitrine
