// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acquisition/surface/plane_step.h"
#include "codec/mesh/face_neighbours.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kPoints = 10'000;  // number of points used to register a scan
// Distances, in multiples of `overlap`, up to which points count. Each pass uses the next distance:
// the first suits the operator's rough placement, the last accepts only the same surface.
constexpr std::array<double, 8> kNarrowing = {40, 20, 10, 6, 4, 2, 1, 1};
constexpr int kSteps = 6;             // iterations at each distance
constexpr std::size_t kFewest = 100;  // least number of overlapping points

// The surface to which scans are registered. Its rim is excluded, because closest points there do
// not correspond.
class FixedSurface {
 public:
  explicit FixedSurface(const TriangleMesh& mesh) : bvh_(mesh), rim_(bvh_.size(), false) {
    const auto across = face_neighbours(bvh_.faces(), bvh_.positions().size());
    for (std::uint32_t t = 0; t < bvh_.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k)
        rim_[t] = rim_[t] || across[t][k] == 3 * t + k;
    }
  }

  std::vector<Counterpart> counterparts(std::span<const Vec3> points, const RigidMotion& motion,
                                        double reach) const {
    std::vector<Counterpart> found;
    for (const Vec3& p : points) {
      const Vec3 moved = motion(p);
      const ClosestTriangle hit = bvh_.closest(moved, {reach * reach});
      if (hit.squared >= reach * reach || rim_[hit.triangle]) continue;
      const TrianglePoints corners = bvh_.triangle(hit.triangle);
      const Vec3 normal = normal_of(corners);
      if (const double size = length(normal); size > 0)
        found.push_back({moved, closest_point(corners, moved), normal * (1 / size)});
    }
    return found;
  }

 private:
  TriangleBvh bvh_;
  std::vector<bool> rim_;
};

std::vector<Vec3> some_of(const std::vector<Vec3>& points) {
  std::vector<Vec3> some;
  const std::size_t step = points.size() / kPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += step)
    some.push_back(points[i]);
  return some;
}

double rms_of(const std::vector<Counterpart>& pairs) {
  double sum = 0;
  for (const Counterpart& pair : pairs) {
    const double d = dot(pair.on - pair.point, pair.normal);
    sum += d * d;
  }
  return pairs.empty() ? 0 : std::sqrt(sum / static_cast<double>(pairs.size()));
}

Unexpected no_overlap(std::size_t scan, std::size_t points) {
  return fail(ErrorCode::kBadInput,
              fmt::format("scan {} overlaps the earlier ones in only {} points; give a better "
                          "start, or scan more of the same parts",
                          scan + 1, points));
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
  constexpr std::uint32_t kNone = UINT32_MAX;
  std::vector<std::uint32_t> places(scan.positions.size(), kNone);
  const auto place = [&](std::uint32_t vertex) {
    if (places[vertex] == kNone) {
      places[vertex] = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(scan.positions[vertex]);
    }
    return places[vertex];
  };
  for (const Triangle& face : scan.faces) {
    if (!is_covered(scan, face, surface, reach))
      mesh.faces.push_back({place(face[0]), place(face[1]), place(face[2])});
  }
}

}  // namespace

bool is_doubtful(const Merged& merged, std::size_t k, const MergeOptions& options) {
  constexpr double kLeastShare = .2, kMostSpread = .4;
  return merged.shares[k] < kLeastShare || merged.rms[k] > kMostSpread * options.overlap;
}

Expected<Merged> merge(std::span<const TriangleMesh> scans, std::span<const RigidMotion> starts,
                       const MergeOptions& options) {
  if (scans.empty() || scans.size() != starts.size())
    return fail(ErrorCode::kBadInput,
                fmt::format("there are {} scans and {} starts; give one start for each scan",
                            scans.size(), starts.size()));
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (scans[k].faces.empty())
      return fail(ErrorCode::kBadInput, fmt::format("scan {} has no face; leave it out", k + 1));
  }
  Merged merged{{scans[0].positions, scans[0].faces, {}}, {RigidMotion{}}, {0}, {1}};
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const FixedSurface target(merged.mesh);
    const std::vector<Vec3> points = some_of(scans[k].positions);
    const std::size_t fewest = std::min(kFewest, points.size());
    RigidMotion motion = starts[k];
    std::vector<Counterpart> pairs;
    for (const double reach : kNarrowing) {
      for (int step = 0; step < kSteps; ++step) {
        pairs = target.counterparts(points, motion, reach * options.overlap);
        if (pairs.size() < fewest) return no_overlap(k, pairs.size());
        motion = then(motion, towards_planes(pairs));
      }
    }
    TriangleMesh moved = scans[k];
    for (Vec3& p : moved.positions)
      p = motion(p);
    add_uncovered(merged.mesh, moved, options.overlap);
    merged.motions.push_back(motion), merged.rms.push_back(rms_of(pairs));
    merged.shares.push_back(static_cast<double>(pairs.size()) / static_cast<double>(points.size()));
  }
  return merged;
}

}  // namespace vitrine::acquisition
