// SPDX-License-Identifier: Apache-2.0
#include "accuracy.h"

#include <algorithm>
#include <cmath>

#include "codec/distance/rigid_alignment.h"
#include "codec/distance/surface_sampler.h"
#include "codec/mesh/triangle_bvh.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr std::size_t kSamples = 200'000, kAlignSamples = 10'000;
constexpr std::uint64_t kSeed = 1;

std::vector<Vec3> points_on(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Vec3> points;
  for (const SurfaceSample& sample : sample_surface(TriangleBvh(mesh), count, kSeed))
    points.push_back(sample.point);
  return points;
}

void lift(std::vector<Vec3>& points, double height) {
  for (Vec3& p : points)
    p.z += height;
}

double top(const TriangleMesh& mesh) {
  const auto height = [](const Vec3& p) { return p.z; };
  return std::ranges::max_element(mesh.positions, {}, height)->z;
}

// Estimates the vertical offset of the points from the surface. Ignores points at least `reach` mm
// away. On a steep surface, the closest point says little about height, so each point is weighted
// by the z component of the surface's normal at its closest point.
double rise(const std::vector<Vec3>& points, const TriangleBvh& surface, double reach) {
  double sum = 0, weight = 0;
  for (const Vec3& p : points) {
    const ClosestTriangle hit = surface.closest(p, {reach * reach, 0});
    if (hit.squared >= reach * reach) continue;
    const TrianglePoints corners = surface.triangle(hit.triangle);
    const Vec3 across = normal_of(corners);
    const double size = length(across);
    if (size == 0) continue;
    const Vec3 normal = across * (1 / size);
    sum += normal.z * dot(normal, closest_point(corners, p) - p);
    weight += normal.z * normal.z;
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

double Accuracy::rms() const {
  return std::max(scan_to_truth.rms, truth_to_scan.rms);
}

double Accuracy::p95() const {
  return std::max(scan_to_truth.p95, truth_to_scan.p95);
}

Distances distances(const TriangleMesh& from, const TriangleMesh& to) {
  const TriangleBvh surface(to);
  std::vector<double> squared;
  double sum = 0;
  std::uint32_t last = 0;
  for (const Vec3& p : points_on(from, kSamples)) {
    const ClosestTriangle hit =
        surface.closest(p, {squared_distance(surface.triangle(last), p), last});
    last = hit.triangle;
    squared.push_back(hit.squared);
    sum += hit.squared;
  }
  const auto count = static_cast<double>(squared.size());
  const auto within = std::ranges::count_if(
      squared, [](double distance) { return distance <= kCovered * kCovered; });
  const auto p95 = squared.begin() + static_cast<std::ptrdiff_t>((squared.size() - 1) * 19 / 20);
  std::nth_element(squared.begin(), p95, squared.end());
  return {std::sqrt(sum / count), std::sqrt(*p95), static_cast<double>(within) / count};
}

Accuracy accuracy(const TriangleMesh& scan, const Truth& truth) {
  return {distances(scan, truth.mesh), distances(seen_part(truth), scan)};
}

TriangleMesh at_height_of(const TriangleMesh& scan, const TriangleMesh& truth) {
  // The alignment is repeated with decreasing `reach`, from kFarthest to kNearest mm. Points
  // farther from the surface than `reach` are ignored.
  constexpr double kFarthest = 8, kNearest = 0.2;
  const TriangleBvh surface(truth);
  std::vector<Vec3> points = points_on(scan, kAlignSamples);
  double height = top(truth) - top(scan);
  lift(points, height);
  for (double reach = kFarthest; reach > kNearest; reach *= 0.75) {
    const double step = rise(points, surface, reach);
    lift(points, step);
    height += step;
  }
  TriangleMesh lifted = scan;
  lift(lifted.positions, height);
  return lifted;
}

TriangleMesh aligned(const TriangleMesh& scan, const TriangleMesh& truth) {
  const RigidMotion motion = align(points_on(scan, kAlignSamples), TriangleBvh(truth));
  TriangleMesh moved = scan;
  for (Vec3& p : moved.positions)
    p = motion(p);
  return moved;
}

}  // namespace vitrine::bench
