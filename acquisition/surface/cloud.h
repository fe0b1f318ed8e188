// SPDX-License-Identifier: Apache-2.0
// The points of all strands, and what makes two of them neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/surface_of.h"
#include "codec/core/vec.h"

namespace vitrine {

// Strands in order of theta over one turn, with the points of all of them in one array besides:
// those of strand k are [first[k], first[k + 1]). Strands of equal theta make one step: those of
// step s are [steps[s], steps[s + 1]).
struct Cloud {
  std::vector<Profile> strands;
  std::vector<std::size_t> first, steps;
  std::vector<Vec3> positions;

  explicit Cloud(std::vector<Profile> strands);
  std::size_t size() const { return positions.size(); }
  std::size_t step_count() const { return steps.size() - 1; }
  std::size_t strands_of(std::size_t step) const { return steps[step + 1] - steps[step]; }
  std::size_t after(std::size_t step, std::size_t count = 1) const {
    return (step + count) % step_count();
  }
};

// Where in `strands`, in order of theta, each step begins, and their number.
std::vector<std::size_t> steps_of(std::span<const Profile> strands);

// The strands without the points that are not kept.
std::vector<Profile> keep(const Cloud& cloud, const std::vector<bool>& kept);

// What holds for the whole scan.
struct Spacing {
  int rows = 1;            // from point to point in a strand, median
  int gap = 1;             // rows from point to point; where there are more, some are missing
  double row_height = 1;   // mm, from row to row, median
  double largest = 0;      // s_max, mm
  double near = 0;         // 4 s_max, mm: what eq. 5 joins at any angle
  double bridge = 0;       // mm: strands whose points are further apart are not joined
  double cos_largest = 0;  // of phi_max
};

Spacing spacing_of(const Cloud& cloud, const SurfaceOptions& options);

// Eq. 5-6: the depths rho differ by `depth`, which is less than 4 s_max, or the surface is seen at
// an angle phi below phi_max, where cos(phi) is the share of their distance that lies across the
// depth.
bool are_joined(double depth, double distance, const Spacing& spacing);

}  // namespace vitrine
