// SPDX-License-Identifier: Apache-2.0
// The points of all profiles, and what makes two of them neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/surface_of.h"
#include "codec/core/vec.h"

namespace vitrine {

// Profiles in order of theta over one turn, with the points of all of them in one array besides:
// those of profile k are [first[k], first[k + 1]).
struct Cloud {
  std::vector<Profile> profiles;
  std::vector<std::size_t> first;
  std::vector<Vec3> positions;

  explicit Cloud(std::vector<Profile> profiles);
  std::size_t size() const { return positions.size(); }
  std::size_t after(std::size_t profile, std::size_t steps = 1) const {
    return (profile + steps) % profiles.size();
  }
};

// Removes the points that are not kept and those profiles that are left with none.
std::vector<Profile> keep(const Cloud& cloud, const std::vector<bool>& kept);

// What holds for the whole scan.
struct Spacing {
  int rows = 1;            // from point to point in a profile, median
  double largest = 0;      // s_max, mm
  double bridge = 0;       // mm across the depth: no gap that is wider is bridged
  double cos_largest = 0;  // of phi_max
};

Spacing spacing_of(const Cloud& cloud, const SurfaceOptions& options);

// Eq. 5-6: the depth rho differs by less than 4 s_max, or the surface is seen at an angle phi below
// phi_max, where cos(phi) is the share of their distance that lies across the depth.
bool are_joined(double rho_a, double rho_b, double distance, const Spacing& spacing);

}  // namespace vitrine
