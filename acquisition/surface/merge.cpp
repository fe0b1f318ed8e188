// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codec/mesh/triangle_bvh.h"

namespace vitrine {
namespace {

constexpr std::size_t kPoints = 20'000;  // that a scan is moved by
// Distances up to which points count, one after the other, in `overlap`s: from the operator's start
// to what is the same surface.
constexpr std::array<double, 5> kNarrowing = {40, 16, 6, 2, 1};
constexpr std::size_t kFewest = 100;  // points that overlap

RigidMotion then(const RigidMotion& first, const RigidMotion& second) {
  RigidMotion both;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& r = second.rows[k];
    both.rows[k] = first.rows[0] * r.x + first.rows[1] * r.y + first.rows[2] * r.z;
  }
  both.shift = second(first.shift);
  return both;
}

std::vector<Vec3> some_of(const std::vector<Vec3>& points) {
  std::vector<Vec3> some;
  const std::size_t step = points.size() / kPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += step)
    some.push_back(points[i]);
  return some;
}

struct Overlap {
  std::vector<Vec3> points;
  double rms = 0;
};

Overlap overlap_of(const std::vector<Vec3>& points, const RigidMotion& motion,
                   const TriangleBvh& surface, double reach) {
  Overlap overlap;
  for (const Vec3& p : points) {
    const SurfacePoint hit = surface.closest(motion(p), {reach * reach});
    if (hit.squared >= reach * reach) continue;
    overlap.points.push_back(motion(p)), overlap.rms += hit.squared;
  }
  if (!overlap.points.empty())
    overlap.rms = std::sqrt(overlap.rms / static_cast<double>(overlap.points.size()));
  return overlap;
}

bool is_covered(const TriangleMesh& scan, const Triangle& face, const TriangleBvh& surface,
                double reach) {
  const Vec3 &a = scan.positions[face[0]], &b = scan.positions[face[1]],
             &c = scan.positions[face[2]];
  return std::ranges::all_of(std::array{a, b, c, (a + b + c) * (1. / 3)}, [&](const Vec3& p) {
    return surface.closest(p, {reach * reach}).squared < reach * reach;
  });
}

void add_uncovered(TriangleMesh& mesh, const TriangleMesh& scan, double reach) {
  const TriangleBvh surface(mesh);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), scan.positions.begin(), scan.positions.end());
  for (const Triangle& face : scan.faces) {
    if (!is_covered(scan, face, surface, reach))
      mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
}

}  // namespace

Expected<Merged> merge(std::span<const TriangleMesh> scans, std::span<const RigidMotion> starts,
                       const MergeOptions& options) {
  if (scans.empty() || scans.size() != starts.size())
    return fail(ErrorCode::kBadInput,
                fmt::format("{} scans and {} starts: give one start for each scan", scans.size(),
                            starts.size()));
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (scans[k].faces.empty())
      return fail(ErrorCode::kBadInput, fmt::format("scan {} has no face: leave it out", k + 1));
  }
  Merged merged{scans[0], {RigidMotion{}}, {0}};
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const TriangleBvh surface(merged.mesh);
    const std::vector<Vec3> points = some_of(scans[k].positions);
    RigidMotion motion = starts[k];
    for (const double reach : kNarrowing) {
      const Overlap overlap = overlap_of(points, motion, surface, reach * options.overlap);
      motion = then(motion, align(overlap.points, surface));
    }
    const Overlap overlap = overlap_of(points, motion, surface, options.overlap);
    if (overlap.points.size() < std::min(kFewest, points.size()))
      return fail(ErrorCode::kBadInput,
                  fmt::format("scan {} overlaps with those before it in {} points only: give a "
                              "better start, or scan more of the same parts",
                              k + 1, overlap.points.size()));
    TriangleMesh moved = scans[k];
    for (Vec3& p : moved.positions)
      p = motion(p);
    add_uncovered(merged.mesh, moved, options.overlap);
    merged.motions.push_back(motion), merged.rms.push_back(overlap.rms);
  }
  return merged;
}

}  // namespace vitrine
