// SPDX-License-Identifier: Apache-2.0
// How far each displayed level is from the original surface.
#pragma once

#include <functional>
#include <vector>

#include "codec/mesh/surface_sampler.h"
#include "codec/mesh/triangle_bvh.h"
#include "codec/mesh/triangle_mesh.h"
#include "codec/simplify/hausdorff_bound.h"
#include "codec/simplify/witness_surface.h"

namespace vitrine {

struct LevelError {
  double max_error = 0;  // model units; no point of either surface is farther from the other
  double rms_error = 0;  // model units; the larger direction's, from 2,000 samples
  std::vector<double> region_errors;  // max_error of each region; the largest is max_error
};

// The regions of a level, numbered from 0 on: per vertex of its own and of the original. Empty:
// there is one.
struct LevelRegions {
  std::vector<std::uint16_t> of_level, of_original;
  std::uint32_t count = 1;
};

// Levels may be measured from several threads at once.
class ErrorMeter {
 public:
  // `original` is the unquantised input with at least one face, finite and with valid indices.
  explicit ErrorMeter(TriangleMesh original);
  ErrorMeter(const ErrorMeter&) = delete;

  // `mesh` is what a level displays: at least one face, model units. max_error is at most a
  // fiftieth above the true maximum (or 1e-6 of the diagonal), but for tangles (HausdorffBound).
  LevelError measure(TriangleMesh mesh, const LevelRegions& regions = {}) const;
  // The same for the original with its vertices moved, by rounding say; fast for small moves.
  using Move = std::function<Vec3(const Vec3&)>;
  LevelError measure_moved(const Move& move, const LevelRegions& regions = {}) const;

  const TriangleBvh& original() const { return bvh_; }

 private:
  // Tells `bound` of the worst samples and what is around them; returns the rms distance.
  double sample_both(const RegionedSurface& level, const RegionedSurface& original,
                     const WitnessSurface& surface, HausdorffBound& bound) const;

  TriangleBvh bvh_;
  WitnessSurface surface_;
  std::vector<SurfaceSample> samples_;
  double negligible_;
};

}  // namespace vitrine
