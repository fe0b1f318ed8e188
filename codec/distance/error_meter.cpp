// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/error_meter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>
#include <utility>

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kSamples = 2'000;  // number of samples on each surface
constexpr std::uint64_t kSeed = 1;
// Per surface: how many of the samples with the largest distances are kept. The triangles that
// contain these samples are bounded first.
constexpr std::size_t kWorst = 32;
constexpr double kTolerance = 1.02;
// errors below this fraction of the original's bounding box diagonal are not refined
constexpr double kNegligible = 1e-6;

double diagonal(const TriangleBvh& bvh) {
  const TriangleBvh::Node& n = bvh.nodes()[0];
  const Vec3 low{n.low[0], n.low[1], n.low[2]}, high{n.high[0], n.high[1], n.high[2]};
  return length(high - low);
}

struct Worst {
  double squared, at_least;  // squared distance to the other surface, and a lower bound of it
  // `triangle` contains the sample. `nearest` is the closest triangle of the other surface.
  std::uint32_t triangle, nearest;
};

struct SampledErrors {
  double rms = 0;
  std::vector<Worst> worst;  // the kWorst samples with the largest distances, largest first
};

SampledErrors sample(std::span<const SurfaceSample> samples, const WitnessSurface& surface) {
  SampledErrors out;
  double sum = 0;
  std::uint32_t last = 0;
  for (const SurfaceSample& s : samples) {
    const ClosestTriangle hit = surface.closest(s.point, last);
    last = hit.triangle;
    sum += hit.squared;
    out.worst.push_back({hit.squared, hit.at_least, s.triangle, hit.triangle});
  }
  out.rms = std::sqrt(sum / static_cast<double>(samples.size()));
  const auto end =
      out.worst.begin() + static_cast<std::ptrdiff_t>(std::min(kWorst, samples.size()));
  std::ranges::partial_sort(out.worst, end, std::greater<>(), &Worst::squared);
  out.worst.erase(end, out.worst.end());
  return out;
}

// Adds the samples with the largest distances, and the triangles that contain them, to `bound`.
// This runs first, because knowing a large distance early saves work later.
void add_worst(HausdorffBound& bound, const SampledErrors& sampled, const RegionedSurface& source,
               const WitnessSurface& target) {
  for (const Worst& w : sampled.worst) {
    bound.choose(source.regions(w.triangle)[0]);
    bound.know_distance(std::sqrt(w.at_least));
    bound.add(source.bvh.triangle(w.triangle), target, w.nearest);
  }
}

// Assigns each vertex of `bvh` its region. `regions` holds one entry per vertex of the mesh from
// which `bvh` was built. An empty `regions` means that there is only one region.
RegionedSurface in_regions(const TriangleBvh& bvh, std::span<const std::uint16_t> regions) {
  RegionedSurface surface{bvh, {}};
  if (regions.empty()) return surface;
  surface.region.reserve(bvh.vertices().size());
  for (const std::uint32_t v : bvh.vertices())
    surface.region.push_back(regions[v]);
  return surface;
}

// Builds the bounding volume hierarchy of `mesh`. Frees the mesh immediately to save memory.
TriangleBvh consume(TriangleMesh mesh) {
  TriangleBvh bvh(mesh);
  mesh = {};
  return bvh;
}

LevelError result(const HausdorffBound& bound, std::uint32_t regions, double rms) {
  LevelError error{
      .max_error = bound.bound(), .rms_error = rms, .region_errors = {}, .cuts = bound.cuts()};
  for (std::uint32_t k = 0; k < regions; ++k)
    error.region_errors.push_back(bound.bound(k));
  return error;
}

}  // namespace

ErrorMeter::ErrorMeter(TriangleMesh original)
    : bvh_(consume(std::move(original))),
      surface_(bvh_),
      samples_(sample_surface(bvh_, kSamples, kSeed)),
      negligible_(kNegligible * diagonal(bvh_)) {}

LevelError ErrorMeter::measure(TriangleMesh mesh, const LevelRegions& regions) const {
  const TriangleBvh bvh = consume(std::move(mesh));
  const WitnessSurface surface(bvh);
  const RegionedSurface level = in_regions(bvh, regions.of_level),
                        original = in_regions(bvh_, regions.of_original);
  HausdorffBound bound(kTolerance, negligible_, regions.count);
  const double rms = sample_both(level, original, surface, bound);
  const Overlaps overlaps = bound.add(level, surface_);
  bound.add(original, surface, overlaps);
  return result(bound, regions.count, rms);
}

LevelError ErrorMeter::measure_moved(const PointMap& move, const LevelRegions& regions) const {
  std::vector<Vec3> moved;
  moved.reserve(bvh_.positions().size());
  std::ranges::transform(bvh_.positions(), std::back_inserter(moved), move);
  const TriangleBvh bvh(bvh_, std::move(moved));
  const WitnessSurface surface(bvh, surface_);
  const RegionedSurface original = in_regions(bvh_, regions.of_original),
                        level{bvh, original.region};
  HausdorffBound bound(kTolerance, negligible_, regions.count);
  const double rms = sample_both(level, original, surface, bound);
  bound.add_twins(surface_, surface, original);
  return result(bound, regions.count, rms);
}

double ErrorMeter::sample_both(const RegionedSurface& level, const RegionedSurface& original,
                               const WitnessSurface& surface, HausdorffBound& bound) const {
  const SampledErrors there = sample(sample_surface(level.bvh, kSamples, kSeed), surface_);
  const SampledErrors back = sample(samples_, surface);
  add_worst(bound, there, level, surface_);
  add_worst(bound, back, original, surface);
  return std::max(there.rms, back.rms);
}

}  // namespace vitrine::inline codec
