// SPDX-License-Identifier: Apache-2.0
// Meshes the profiles of one revolution into a surface. Source: [WLL] eq. 5 and 6.
#pragma once

#include <cstdint>
#include <span>

#include "acquisition/profile/profile.h"
#include "acquisition/profile/sampling.h"
#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

struct SurfaceOptions {
  // s_max of [WLL] eq. 5, in mm (Spacing::largest). 0 derives it from the profiles.
  double largest_spacing = 0;
  double largest_angle = 75;        // phi_max of [WLL] eq. 6, in degrees
  double largest_hole = 2;          // largest hole or gap that is closed, in mm; 0: none
  std::size_t smallest_piece = 30;  // pieces with fewer points are dropped
  // Calibrated standard deviation of a point's rho, in mm. 0 disables smoothing.
  double noise = 0;
  SamplingOptions sampling{.window = 1};
};

struct SurfaceReport {
  std::uint64_t points = 0;  // number of points before processing
  // Numbers of points dropped as outliers and as isolated pieces (strays.h).
  std::uint64_t outliers = 0, isolated = 0;
  std::uint64_t seen_twice = 0;  // number of points dropped as second views (first_views())
  std::uint64_t filled = 0;      // number of points added in gaps (fill_gaps())
  std::uint64_t smoothed = 0;    // number of points moved by smoothing (smooth())
  std::uint64_t sampled = 0;     // number of points left after sampling
  std::uint64_t holes = 0;       // number of holes closed in the mesh (close_holes())
  double spacing = 0;            // the distance s_max ([WLL] eq. 5) that was used, in mm
};

struct ScannedSurface {
  // In mm, z along the table's axis. Faces are counter-clockwise from outside.
  TriangleMesh mesh;
  SurfaceReport report;
};

// Makes a mesh from the `profiles` of one revolution, which may be in any order. The last profile
// joins the first. Profiles whose rows show two surfaces are split into strands (steps.h), and
// each strand joins the nearest strands. The order of processing is: drop outliers, isolated points
// and second views beyond the axis; fill gaps; smooth; sample; mesh; close small holes. No edge has
// more than two faces, and these traverse it in opposite directions. A vertex may have several
// fans, which the import splits. The object's top and bottom stay open, apart from holes up to
// `largest_hole`. Fails with kBadInput, giving the reason, if no points are left to mesh. Takes O(n
// log n) time.
Expected<ScannedSurface> surface_of(std::span<const Profile> profiles,
                                    const SurfaceOptions& options);

}  // namespace vitrine::acquisition
