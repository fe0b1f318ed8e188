// SPDX-License-Identifier: Apache-2.0
// The points of all strands of a scan, and the distances up to which points are neighbours. A
// strand is a line of measured points with at most one point per image row (steps.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/profile/profile.h"
#include "acquisition/surface/surface_of.h"
#include "codec/core/vec.h"

namespace vitrine::acquisition {

// The strands of a scan, sorted by theta over one revolution. All their points are numbered in one
// sequence: strand k has the points [first[k], first[k + 1]). Strands of equal theta form a step:
// step s has the strands [steps[s], steps[s + 1]).
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

// Returns the index in `strands` at which each step begins, followed by the number of strands.
std::vector<std::size_t> steps_of(std::span<const Profile> strands);

// Returns the strands without the points whose flag in `kept` is false.
std::vector<Profile> keep(const Cloud& cloud, const std::vector<bool>& kept);

// Distances and angles that are the same for the whole scan.
struct Spacing {
  // Median number of rows between consecutive points of a strand.
  int rows = 1;
  // Consecutive points at most this many rows apart have no gap between them.
  int gap = 1;
  double row_height = 1;  // median height of a row, in mm
  // s_max of [WLL] eq. 5, in mm: the larger of the spacing along strands and the spacing between
  // steps.
  double largest = 0;
  // 4 s_max, in mm. [WLL] eq. 5 joins points closer than this at any angle.
  double near = 0;
  // Strands whose points are farther apart than this, in mm, are not joined.
  double bridge = 0;
  double cos_largest = 0;  // cosine of phi_max ([WLL] eq. 6)
};

Spacing spacing_of(const Cloud& cloud, const SurfaceOptions& options);

// Returns whether [WLL] eq. 5 or 6 joins two points. Equation 5 joins points whose depths rho
// differ by less than 4 s_max; `depth` is that difference. Equation 6 joins points if the surface
// between them is seen at an angle phi < phi_max. cos(phi) is the share of their `distance` that is
// perpendicular to the depth.
bool are_joined(double depth, double distance, const Spacing& spacing);

}  // namespace vitrine::acquisition
