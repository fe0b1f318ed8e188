// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/error_meter.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "codec/mesh/surface_sampler.h"

namespace vitrine {
namespace {

constexpr std::size_t kSamples = 10'000;  // per direction
constexpr std::uint64_t kSeed = 1;
constexpr double kTolerance = 1.1;
constexpr double kNegligible = 1e-9;  // of the diagonal

double diagonal(const TriangleBvh& bvh) {
  const TriangleBvh::Node& n = bvh.nodes()[0];
  const Vec3 low{n.low[0], n.low[1], n.low[2]}, high{n.high[0], n.high[1], n.high[2]};
  return length(high - low);
}

struct Sampled {
  double rms, max;
};

Sampled sample(std::span<const Vec3> points, const WitnessSurface& surface) {
  double sum = 0, max = 0;
  std::uint32_t last = 0;
  for (const Vec3& p : points) {
    const SurfacePoint hit = surface.closest(p, last);
    last = hit.triangle;
    sum += hit.squared, max = std::max(max, hit.squared);
  }
  return {std::sqrt(sum / static_cast<double>(points.size())), std::sqrt(max)};
}

}  // namespace

ErrorMeter::ErrorMeter(const TriangleMesh& original)
    : bvh_(original),
      surface_(bvh_, original),
      samples_(sample_surface(bvh_.triangles(), kSamples, kSeed)),
      negligible_(kNegligible * diagonal(bvh_)) {}

LevelError ErrorMeter::measure(const TriangleMesh& level) const {
  const TriangleBvh bvh(level);
  const WitnessSurface surface(bvh, level);
  const Sampled there = sample(sample_surface(bvh.triangles(), kSamples, kSeed), surface_);
  const Sampled back = sample(samples_, surface);

  HausdorffBound bound(kTolerance, negligible_);
  bound.know(std::max(there.max, back.max));
  bound.add(bvh, surface_);
  bound.add(bvh_, surface);
  return {.max_error = bound.bound(), .rms_error = std::max(there.rms, back.rms)};
}

}  // namespace vitrine
