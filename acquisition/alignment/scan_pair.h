// SPDX-License-Identifier: Apache-2.0
// Finds the relative pose of two scans without an initial estimate, and judges whether it may be
// wrong.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/alignment/point_features.h"
#include "acquisition/alignment/registration.h"
#include "acquisition/alignment/sight_lines.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

// A scan of an object in one pose.
struct PoseScan {
  std::string name;              // name of the scan in error messages
  TriangleMesh mesh;             // positions in mm
  std::vector<SightLine> lines;  // sight lines in the frame of `mesh`
};

// A scan with the data that its registration needs.
class PreparedScan {
 public:
  // `spacing` is the approximate distance, in mm, between the points for which features are
  // computed.
  PreparedScan(const PoseScan& scan, double spacing);

  const FixedSurface& surface() const { return surface_; }
  const SurfacePoints& points() const { return points_; }
  const std::vector<PointFeature>& features() const { return features_; }
  const SurfacePoints& vertices() const { return vertices_; }
  // The sight lines that the scan's own surface does not cross.
  const std::vector<SightLine>& lines() const { return lines_; }
  double spacing() const { return spacing_; }

 private:
  double spacing_;
  FixedSurface surface_;
  SurfacePoints points_, vertices_;
  std::vector<PointFeature> features_;
  std::vector<SightLine> lines_;
};

// Returns a distance between points with features, in mm. At this distance, the largest scan has
// about 6,000 such points.
double spacing_for(std::span<const PoseScan> scans);

// Returns the share of a scan's sight lines that the surface of another scan crosses more than 1.5
// mm in front of the measured point. `motion` moves the lines into the frame of the surface. In a
// correct pose, hardly any line is crossed.
double crossed_share(std::span<const SightLine> lines, const FixedSurface& surface,
                     const RigidMotion& motion);

struct PairFit {
  RigidMotion motion;  // motion of the first scan onto the second scan
  // Share of the vertices of one scan that lie on the surface of the other scan. Each of the two
  // scans has such a share; this is the larger one.
  double overlap = 0;
  double rms = 0;      // rms distance of the overlapping vertices from the other scan, in mm
  double crossed = 0;  // the larger value of crossed_share() for the two scans
};

// Judges a motion. Two surfaces closer than `reach` mm count as the same surface.
PairFit judge_pair(const PreparedScan& from, const PreparedScan& to, const RigidMotion& motion,
                   double reach);

// Returns the candidate poses that are left after rough registration and the check of sight lines,
// refined and judged. Poses that are alike are returned only once. Sorted by overlap, the largest
// first.
std::vector<PairFit> pair_fits(const PreparedScan& from, const PreparedScan& to, double reach,
                               std::uint64_t seed);

}  // namespace vitrine::acquisition
