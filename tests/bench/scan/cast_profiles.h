// SPDX-License-Identifier: Apache-2.0
// A simulated perfect scanner. It makes profiles by casting rays from outside towards the axis.
#pragma once

#include <vector>

#include "acquisition/profile/profile.h"
#include "codec/mesh/triangle_mesh.h"
#include "support/product_names.h"

namespace vitrine::bench {

// Makes `steps` profiles over one revolution. Each profile has a point every `row_mm` of height:
// the outermost point of `object` in the profile's half plane.
std::vector<Profile> cast_profiles(const TriangleMesh& object, int steps, double row_mm);

// Adds normally distributed noise to the rho of every point. `deviation` is the standard deviation
// in mm.
void add_noise(std::vector<Profile>& profiles, double deviation);

}  // namespace vitrine::bench
