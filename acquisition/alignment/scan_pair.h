// SPDX-License-Identifier: Apache-2.0
// Finds how one scan lies on another, without a start, and judges whether that may be wrong.
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
  std::string name;              // for errors
  TriangleMesh mesh;             // mm
  std::vector<SightLine> lines;  // in the same frame
};

// A scan with the data that its registration needs.
class PreparedScan {
 public:
  // `spacing` is the distance of the points that get features, in mm.
  PreparedScan(const PoseScan& scan, double spacing);

  const FixedSurface& surface() const { return surface_; }
  const SurfacePoints& points() const { return points_; }
  const std::vector<PointFeature>& features() const { return features_; }
  const SurfacePoints& vertices() const { return vertices_; }
  // The lines on which the scan itself has no surface.
  const std::vector<SightLine>& lines() const { return lines_; }
  double spacing() const { return spacing_; }

 private:
  double spacing_;
  FixedSurface surface_;
  SurfacePoints points_, vertices_;
  std::vector<PointFeature> features_;
  std::vector<SightLine> lines_;
};

// Returns a spacing that gives the largest of the scans about 6,000 points.
double spacing_for(std::span<const PoseScan> scans);

// Returns the share of a scan's sight lines that the surface of another scan would have
// interrupted, more than 1.5 mm in front of the measured point. `motion` moves the lines into the
// frame of the surface. Right motions cross hardly any line.
double crossed_share(std::span<const SightLine> lines, const FixedSurface& surface,
                     const RigidMotion& motion);

struct PairFit {
  RigidMotion motion;  // of the first scan onto the second
  // Share of the vertices of one scan that lie on the other: the larger of both shares.
  double overlap = 0;
  double rms = 0;      // mm, of the distances there
  double crossed = 0;  // larger of the two crossed shares
};

// Judges a motion. `reach` in mm: surfaces closer than this count as the same surface.
PairFit judge_pair(const PreparedScan& from, const PreparedScan& to, const RigidMotion& motion,
                   double reach);

// Returns the candidates that rough registration and the sight lines leave, refined and judged,
// without repetitions. Those with the largest overlap come first.
std::vector<PairFit> pair_fits(const PreparedScan& from, const PreparedScan& to, double reach,
                               std::uint64_t seed);

}  // namespace vitrine::acquisition
