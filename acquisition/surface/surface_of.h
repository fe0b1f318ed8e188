// SPDX-License-Identifier: Apache-2.0
// Profiles to a triangle mesh (paper, eq. 5-6).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/profile/profile.h"
#include "codec/core/expected.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct SurfaceOptions {
  double largest_spacing = 0;  // s_max in mm; 0: from the profiles
  double largest_angle = 80;   // phi_max, degrees
  double largest_hole = 2;     // mm along a profile; 0 fills none
};

struct SurfaceReport {
  std::uint64_t points = 0, outliers = 0, isolated = 0, filled = 0;
  double spacing = 0;  // s_max as used, mm
};

struct Surface {
  TriangleMesh mesh;  // mm, z along the table's axis; faces counter-clockwise from outside
  SurfaceReport report;
};

// `profiles` in order of theta over one turn; the last joins the first. Fails (kBadInput) where
// nothing is left to mesh, saying why.
Expected<Surface> surface_of(std::span<const Profile> profiles, const SurfaceOptions& options);

}  // namespace vitrine
