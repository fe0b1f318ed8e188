// SPDX-License-Identifier: Apache-2.0
// A scanner without fault: profiles by casting rays from around the axis.
#pragma once

#include <vector>

#include "acquisition/profile/profile.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::bench {

// `steps` profiles over one turn, a point every `row_mm` of height where the half plane from the
// axis meets `object` first as seen from outside.
std::vector<Profile> cast_profiles(const TriangleMesh& object, int steps, double row_mm);

// Moves every point in rho by normally distributed noise.
void add_noise(std::vector<Profile>& profiles, double deviation);

}  // namespace vitrine::bench
