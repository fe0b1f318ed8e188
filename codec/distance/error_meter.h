// SPDX-License-Identifier: Apache-2.0
// Measures the distance of each displayed level from the original surface.
#pragma once

#include <functional>
#include <vector>

#include "codec/distance/hausdorff_bound.h"
#include "codec/distance/surface_sampler.h"
#include "codec/distance/witness_surface.h"
#include "codec/mesh/triangle_bvh.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

struct LevelError {
  // Upper bound, in model units: no point of either surface is farther than this from the other
  // surface.
  double max_error = 0;
  // Root mean square distance in model units, from 2,000 samples on each surface. It is the larger
  // of the values of the two directions.
  double rms_error = 0;
  std::vector<double> region_errors;  // max_error of each region; the largest equals max_error
  std::uint64_t cuts = 0;  // how often triangles were cut to bound max_error, a measure of the work
};

// The region of each vertex of a level and of the original, numbered from 0. If all vertices are in
// one region, the vectors are empty.
struct LevelRegions {
  std::vector<std::uint16_t> of_level, of_original;
  std::uint32_t count = 1;
};

// Measures levels against one original. Several threads may measure at the same time.
class ErrorMeter {
 public:
  // `original` is the input mesh before quantisation. It must have at least one face, finite
  // positions and valid indices.
  explicit ErrorMeter(TriangleMesh original);
  ErrorMeter(const ErrorMeter&) = delete;

  // Measures the displayed mesh of a level, in model units. `mesh` must have at least one face.
  // max_error exceeds the true maximum by at most 2 %, or by at most 1e-6 of the diagonal of the
  // original's bounding box. If a surface crosses or coincides with itself, max_error may be larger
  // (see HausdorffBound).
  LevelError measure(TriangleMesh mesh, const LevelRegions& regions = {}) const;
  // Measures a copy of the original whose vertices were moved by `move`, for example rounded to a
  // lattice. Fast if the vertices move only slightly.
  using PointMap = std::function<Vec3(const Vec3&)>;
  LevelError measure_moved(const PointMap& move, const LevelRegions& regions = {}) const;

  const WitnessSurface& original() const { return surface_; }

 private:
  // Samples both surfaces. Adds the samples with the largest distances, and the triangles that
  // contain them, to `bound`. Returns the larger rms distance of the two directions.
  double sample_both(const RegionedSurface& level, const RegionedSurface& original,
                     const WitnessSurface& surface, HausdorffBound& bound) const;

  TriangleBvh bvh_;
  WitnessSurface surface_;
  std::vector<SurfaceSample> samples_;
  double negligible_;
};

}  // namespace vitrine::inline codec
