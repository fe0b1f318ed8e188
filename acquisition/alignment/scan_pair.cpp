// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/scan_pair.h"

#include <algorithm>
#include <cmath>

#include "acquisition/alignment/pose_search.h"
#include "acquisition/alignment/ray_cast.h"
#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

// approximate number of points with features in the largest scan
constexpr double kPoints = 6'000;
constexpr std::size_t kVertices = 3'000;  // number of vertices used for registration
constexpr double kFeatureReach = 5;       // radius of features, in multiples of the spacing
// Distance in mm. A surface closer than this to a measured point does not count as crossing the
// point's sight line.
constexpr double kMargin = 1.5;
// Largest distances between paired points in the rounds of the rough registration, in multiples of
// the spacing.
constexpr std::array kFirstReaches = {3., 2., 1.};
// Largest distances between paired points in the rounds of the final registration, in multiples of
// `reach`.
constexpr std::array kLastReaches = {4., 2., 1., 1.};
constexpr int kSteps = 5;
constexpr double kSameDegrees = 3;

std::vector<double> scaled(std::span<const double> reaches, double unit) {
  std::vector<double> all(reaches.begin(), reaches.end());
  for (double& reach : all)
    reach *= unit;
  return all;
}

// rough registration uses every fourth vertex and every fourth sight line
constexpr std::size_t kRoughPart = 4;
// A pose is dropped if, after rough registration, surfaces cross a larger share of the sight lines
// than this. The limit is generous: a rough pose may be off by 1 mm, and then surfaces cross more
// sight lines than in the correct pose.
constexpr double kRoughlyCrossed = .15;

template <class T>
std::vector<T> thinned(const std::vector<T>& all) {
  std::vector<T> few;
  for (std::size_t i = 0; i < all.size(); i += kRoughPart)
    few.push_back(all[i]);
  return few;
}

// Registers the candidates roughly. Drops the poses that the sight lines contradict. If several
// poses are alike, keeps only the first.
std::vector<RigidMotion> rough_poses(const PreparedScan& from, const PreparedScan& to,
                                     std::span<const RigidMotion> candidates) {
  const SurfacePoints few = {thinned(from.vertices().at), thinned(from.vertices().normals)};
  const std::vector<SightLine> there = thinned(from.lines()), here = thinned(to.lines());
  const auto reaches = scaled(kFirstReaches, from.spacing());
  const Vec3 middle = middle_of(few.at);
  std::vector<RigidMotion> poses;
  for (const RigidMotion& candidate : candidates) {
    const RigidMotion pose = register_points(few, to.surface(), candidate, reaches, kSteps);
    const bool is_known = std::ranges::any_of(poses, [&](const RigidMotion& other) {
      return are_alike(other, pose, middle, kSameDegrees, from.spacing());
    });
    if (is_known || crossed_share(there, to.surface(), pose) > kRoughlyCrossed ||
        crossed_share(here, from.surface(), inverse(pose)) > kRoughlyCrossed)
      continue;
    poses.push_back(pose);
  }
  return poses;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double spacing_for(std::span<const PoseScan> scans) {
  double largest = 0;
  for (const PoseScan& scan : scans)
    largest = std::max(largest, area_of(scan.mesh));
  return std::sqrt(largest / kPoints);
}

PreparedScan::PreparedScan(const PoseScan& scan, double spacing)
    : spacing_(spacing),
      surface_(scan.mesh),
      points_(evenly_spaced(scan.mesh, spacing)),
      vertices_(some_vertices(scan.mesh, kVertices)),
      features_(point_features(points_, kFeatureReach * spacing)) {
  for (const SightLine& line : scan.lines) {
    if (!hits(surface_.bvh(), line.point + line.towards * kMargin, line.towards))
      lines_.push_back(line);
  }
}

double crossed_share(std::span<const SightLine> lines, const FixedSurface& surface,
                     const RigidMotion& motion) {
  const auto crossed = std::ranges::count_if(lines, [&](const SightLine& line) {
    const Vec3 towards = turned(motion, line.towards);
    return hits(surface.bvh(), motion(line.point) + towards * kMargin, towards);
  });
  return share(static_cast<std::size_t>(crossed), lines.size());
}

PairFit judge_pair(const PreparedScan& from, const PreparedScan& to, const RigidMotion& motion,
                   double reach) {
  const RigidMotion back = inverse(motion);
  const auto there = to.surface().counterparts(from.vertices(), motion, reach);
  const auto here = from.surface().counterparts(to.vertices(), back, reach);
  return {.motion = motion,
          .overlap = std::max(share(there.size(), from.vertices().size()),
                              share(here.size(), to.vertices().size())),
          .rms = std::max(rms_of(there), rms_of(here)),
          .crossed = std::max(crossed_share(from.lines(), to.surface(), motion),
                              crossed_share(to.lines(), from.surface(), back))};
}

std::vector<PairFit> pair_fits(const PreparedScan& from, const PreparedScan& to, double reach,
                               std::uint64_t seed) {
  const auto matches = mutual_matches(from.features(), to.features());
  const PoseSearch search{.reach = 1.5 * from.spacing(), .seed = seed};
  const auto candidates = candidate_poses(from.points(), to.points(), matches, search);
  const Vec3 middle = middle_of(from.vertices().at);
  const auto reaches = scaled(kLastReaches, reach);
  std::vector<PairFit> fits;
  for (const RigidMotion& pose : rough_poses(from, to, candidates)) {
    const RigidMotion motion =
        register_points(from.vertices(), to.surface(), pose, reaches, kSteps);
    const bool is_known = std::ranges::any_of(fits, [&](const PairFit& fit) {
      return are_alike(fit.motion, motion, middle, kSameDegrees, from.spacing());
    });
    if (!is_known) fits.push_back(judge_pair(from, to, motion, reach));
  }
  std::ranges::stable_sort(fits, std::greater{}, &PairFit::overlap);
  return fits;
}

}  // namespace vitrine::acquisition
