// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/error_meter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

namespace vitrine {
namespace {

constexpr std::size_t kSamples = 4'000;  // per direction
constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kWorst = 32;  // samples per direction that are looked at first
constexpr double kTolerance = 1.15;
constexpr double kNegligible = 1e-6;  // of the diagonal

double diagonal(const TriangleBvh& bvh) {
  const TriangleBvh::Node& n = bvh.nodes()[0];
  const Vec3 low{n.low[0], n.low[1], n.low[2]}, high{n.high[0], n.high[1], n.high[2]};
  return length(high - low);
}

struct Worst {
  double squared;
  std::uint32_t triangle, nearest;  // of the surface sampled, of the other one
};

struct Sampled {
  double rms = 0;
  std::vector<Worst> worst;  // descending
};

Sampled sample(std::span<const SurfaceSample> samples, const WitnessSurface& surface) {
  Sampled out;
  double sum = 0;
  std::uint32_t last = 0;
  for (const SurfaceSample& s : samples) {
    const SurfacePoint hit = surface.closest(s.point, last);
    last = hit.triangle;
    sum += hit.squared;
    out.worst.push_back({hit.squared, s.triangle, hit.triangle});
  }
  out.rms = std::sqrt(sum / static_cast<double>(samples.size()));
  const auto end =
      out.worst.begin() + static_cast<std::ptrdiff_t>(std::min(kWorst, samples.size()));
  std::ranges::partial_sort(out.worst, end, std::greater<>(), &Worst::squared);
  out.worst.erase(end, out.worst.end());
  return out;
}

// The worst samples tell where to look first: a large distance known early spares work later.
void add_worst(HausdorffBound& bound, const Sampled& sampled, const TriangleBvh& source,
               std::span<const CornerRegions> regions, const WitnessSurface& target) {
  for (const Worst& w : sampled.worst) {
    bound.choose(regions[w.triangle][0]);
    bound.know(std::sqrt(w.squared));
    bound.add(source.triangle(w.triangle), target, w.nearest);
  }
}

// Of faces, in the order of the triangles of `bvh`.
std::vector<CornerRegions> in_order(const TriangleBvh& bvh, std::span<const CornerRegions> faces) {
  std::vector<CornerRegions> out;
  out.reserve(faces.size());
  for (std::uint32_t t = 0; t < faces.size(); ++t)
    out.push_back(faces[bvh.face(t)]);
  return out;
}

LevelError result(const HausdorffBound& bound, std::uint32_t regions, double rms) {
  LevelError error{.max_error = bound.bound(), .rms_error = rms, .region_errors = {}};
  for (std::uint32_t k = 0; k < regions; ++k)
    error.region_errors.push_back(bound.bound(k));
  return error;
}

}  // namespace

struct ErrorMeter::Sides {
  const TriangleBvh& level;
  std::vector<CornerRegions> of_level, of_original;
};

ErrorMeter::ErrorMeter(const TriangleMesh& original)
    : bvh_(original),
      surface_(bvh_),
      samples_(sample_surface(bvh_, kSamples, kSeed)),
      negligible_(kNegligible * diagonal(bvh_)) {}

LevelRegions ErrorMeter::whole(const TriangleMesh& level) const {
  LevelRegions one;
  one.of_level.resize(level.faces.size());
  one.of_original.resize(bvh_.size());
  return one;
}

LevelError ErrorMeter::measure(const TriangleMesh& level, const LevelRegions& regions) const {
  const TriangleBvh bvh(level);
  const WitnessSurface surface(bvh);
  const Sides sides{bvh, in_order(bvh, regions.of_level), in_order(bvh_, regions.of_original)};
  HausdorffBound bound(kTolerance, negligible_, regions.count);
  const double rms = sample_both(sides, surface, bound);
  const std::vector<std::uint16_t> settled = bound.add(bvh, sides.of_level, surface_);
  bound.add(bvh_, sides.of_original, surface, settled);
  return result(bound, regions.count, rms);
}

LevelError ErrorMeter::measure_moved(const TriangleMesh& moved, const LevelRegions& regions) const {
  const TriangleBvh bvh(bvh_, moved);
  const WitnessSurface surface(bvh, surface_);
  const auto of_original = in_order(bvh_, regions.of_original);
  const Sides sides{bvh, of_original, of_original};
  HausdorffBound bound(kTolerance, negligible_, regions.count);
  const double rms = sample_both(sides, surface, bound);
  bound.add_twins(surface_, surface, sides.of_original);
  return result(bound, regions.count, rms);
}

double ErrorMeter::sample_both(const Sides& sides, const WitnessSurface& surface,
                               HausdorffBound& bound) const {
  const Sampled there = sample(sample_surface(sides.level, kSamples, kSeed), surface_);
  const Sampled back = sample(samples_, surface);
  add_worst(bound, there, sides.level, sides.of_level, surface_);
  add_worst(bound, back, bvh_, sides.of_original, surface);
  return std::max(there.rms, back.rms);
}

}  // namespace vitrine
