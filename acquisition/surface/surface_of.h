// SPDX-License-Identifier: Apache-2.0
// Profiles to a triangle mesh (paper, eq. 5-6).
#pragma once

#include <cstdint>
#include <span>

#include "acquisition/profile/profile.h"
#include "acquisition/profile/sampling.h"
#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct SurfaceOptions {
  double largest_spacing = 0;       // s_max in mm; 0: from the profiles
  double largest_angle = 75;        // phi_max, degrees
  double largest_hole = 2;          // mm; 0 fills none
  std::size_t smallest_piece = 30;  // points
  double noise = 0;  // mm: standard deviation of a point's rho, as calibrated; 0: the
                     // points stay where they were measured
  SamplingOptions sampling{.window = 1};
};

struct SurfaceReport {
  std::uint64_t points = 0;                  // as they came
  std::uint64_t outliers = 0, isolated = 0;  // dropped (strays.h)
  std::uint64_t seen_twice = 0;              // dropped (second_views.h)
  std::uint64_t filled = 0;                  // put into gaps (fill_gaps.h)
  std::uint64_t smoothed = 0;                // moved (smooth.h)
  std::uint64_t sampled = 0;                 // what is left after sampling
  std::uint64_t holes = 0;                   // closed in the mesh (close_holes.h)
  double spacing = 0;                        // s_max as used, mm
};

struct ScannedSurface {
  TriangleMesh mesh;  // mm, z along the table's axis; faces counter-clockwise from outside
  SurfaceReport report;
};

// `profiles` of one turn, in any order; the last joins the first. Rows that show two surfaces part
// a profile into strands (strands.h), which are joined where they are nearest. In this order:
// outliers, isolated points, what is seen a second time beyond the axis, filling, smoothing,
// sampling, mesh, small holes. No edge has more than two faces, and these run along it in opposite
// directions; a vertex may have more than one fan, which the import parts. Nothing closes the
// object's top and bottom where no laser came, but for holes up to `largest_hole`. Fails
// (kBadInput) where nothing is left to mesh, saying why. O(n log n).
Expected<ScannedSurface> surface_of(std::span<const Profile> profiles,
                                    const SurfaceOptions& options);

}  // namespace vitrine
