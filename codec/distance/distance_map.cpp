// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/distance_map.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "codec/core/bounds.h"
#include "codec/distance/rigid_alignment.h"
#include "codec/distance/surface_distance.h"
#include "codec/distance/surface_sampler.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kAlignSamples = 5'000;
// Largest distance that rounding can cause between equal surfaces, as a share of the bounding box
// diagonal.
constexpr double kNoise = 1e-9;
// Colours at -range, 0 and range, as sRGB values.
constexpr Vec3 kBelow{33, 72, 184}, kSame{224, 224, 220}, kAbove{190, 38, 34};

// Returns the distance of each vertex of `a` to `b`, with a sign: positive if the vertex lies on
// the side to which the closest face of `b` points.
std::vector<double> signed_distances(const TriangleMesh& a, const TriangleBvh& b) {
  std::vector<double> distances;
  distances.reserve(a.positions.size());
  std::uint32_t last = 0;
  for (const Vec3& p : a.positions) {
    const ClosestTriangle hit = b.closest(p, {squared_distance(b.triangle(last), p), last});
    last = hit.triangle;
    const TrianglePoints face = b.triangle(hit.triangle);
    const double side = dot(p - closest_point(face, p), normal_of(face));
    distances.push_back(std::copysign(std::sqrt(hit.squared), side));
  }
  return distances;
}

// Returns the absolute distance that 95 % of `distances` do not exceed. If this distance is only
// rounding noise, because just a small part of the surface has changed, returns the largest
// distance.
double usual(const std::vector<double>& distances, double noise) {
  std::vector<double> sizes(distances.size());
  std::ranges::transform(distances, sizes.begin(), [](double d) { return std::abs(d); });
  const auto p95 = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 19 / 20);
  std::nth_element(sizes.begin(), p95, sizes.end());
  return *p95 > noise ? *p95 : std::max(noise, *std::ranges::max_element(sizes));
}

Colour colour_of(double distance, double range) {
  const double share = range > 0 ? std::clamp(distance / range, -1.0, 1.0) : 0;
  const Vec3 mixed = kSame + ((share < 0 ? kBelow : kAbove) - kSame) * std::abs(share);
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(mixed.x), byte(mixed.y), byte(mixed.z)};
}

}  // namespace

Expected<TriangleMesh> aligned(const TriangleMesh& a, const TriangleMesh& b, std::uint64_t seed) {
  if (auto ok = check_measurable(a, b); !ok) return tl::unexpected(ok.error());
  std::vector<Vec3> points;
  for (const SurfaceSample& sample : sample_surface(TriangleBvh(a), kAlignSamples, seed))
    points.push_back(sample.point);
  const RigidMotion motion = align(points, TriangleBvh(b));
  TriangleMesh moved = a;
  for (Vec3& p : moved.positions)
    p = motion(p);
  return moved;
}

Expected<DistanceMap> distance_map(TriangleMesh a, const TriangleMesh& b,
                                   std::optional<double> range) {
  if (auto ok = check_measurable(a, b); !ok) return tl::unexpected(ok.error());
  const std::vector<double> distances = signed_distances(a, TriangleBvh(b));
  const Bounds box = bounds_of(b.positions);
  const double noise = kNoise * length(box.high - box.low);
  DistanceMap map{.mesh = std::move(a), .range = range ? *range : usual(distances, noise)};
  map.mesh.attributes.colours.clear();
  for (const double distance : distances)
    map.mesh.attributes.colours.push_back(colour_of(distance, map.range));
  return map;
}

}  // namespace vitrine::inline codec
