// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/pose_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

// Smallest accepted ratio of the shorter to the longer of two corresponding edges of a triple.
constexpr double kEdgeShare = .9;
// Least length of a triple's edges, in multiples of `reach`. Shorter triples do not determine a
// motion well.
constexpr double kLeastEdge = 4;
// smallest accepted cosine between the normals of matched points
constexpr double kCosNormals = .86;
constexpr double kAlikeDegrees = 8, kAlikeReaches = 3;
// number of best triples from which different motions are chosen
constexpr std::size_t kKept = 2'000;

class Search {
 public:
  Search(const SurfacePoints& from, const SurfacePoints& to, std::span<const FeatureMatch> matches,
         const PoseSearch& options)
      : from_(from), to_(to), matches_(matches), options_(options), random_(options.seed) {}

  struct Scored {
    std::size_t score = 0;
    std::array<std::size_t, 3> triple{};
    auto operator<=>(const Scored&) const = default;
  };

  // Returns triples with their scores, the highest score first. The score is the number of matches
  // that agree with the triple's motion.
  std::vector<Scored> triples() {
    std::vector<Scored> all;
    for (int trial = 0; trial < options_.trials; ++trial) {
      const std::array<std::size_t, 3> triple = {draw(), draw(), draw()};
      if (!is_congruent(triple)) continue;
      const RigidMotion motion = motion_of(triple);
      if (!keeps_normals(motion, triple)) continue;
      all.push_back({agreeing(motion), triple});
      if (all.size() >= 4 * kKept) keep_best(all);
    }
    keep_best(all);
    return all;
  }

  RigidMotion motion_of(const std::array<std::size_t, 3>& triple) const {
    std::array<Vec3, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k)
      a[k] = from_point(triple[k]), b[k] = to_point(triple[k]);
    return fit_motion(a, b);
  }

 private:
  const Vec3& from_point(std::size_t match) const { return from_.at[matches_[match].from]; }
  const Vec3& to_point(std::size_t match) const { return to_.at[matches_[match].to]; }
  std::size_t draw() { return static_cast<std::size_t>(random_() % matches_.size()); }

  bool is_congruent(const std::array<std::size_t, 3>& triple) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = triple[k], j = triple[(k + 1) % 3];
      const double a = length(from_point(i) - from_point(j)), b = length(to_point(i) - to_point(j));
      if (std::min(a, b) < kEdgeShare * std::max(a, b)) return false;
      if (std::min(a, b) < kLeastEdge * options_.reach) return false;
    }
    return true;
  }

  bool agree(const RigidMotion& motion, std::size_t match) const {
    const Vec3 normal = turned(motion, from_.normals[matches_[match].from]);
    return dot(normal, to_.normals[matches_[match].to]) >= kCosNormals;
  }
  bool keeps_normals(const RigidMotion& motion, const std::array<std::size_t, 3>& triple) const {
    return std::ranges::all_of(triple, [&](std::size_t match) { return agree(motion, match); });
  }

  std::size_t agreeing(const RigidMotion& motion) const {
    std::size_t count = 0;
    for (std::size_t match = 0; match < matches_.size(); ++match) {
      const Vec3 d = motion(from_point(match)) - to_point(match);
      if (dot(d, d) <= options_.reach * options_.reach && agree(motion, match)) ++count;
    }
    return count;
  }

  static void keep_best(std::vector<Scored>& all) {
    std::ranges::sort(all, std::greater{});
    all.resize(std::min(all.size(), kKept));
  }

  const SurfacePoints &from_, &to_;
  std::span<const FeatureMatch> matches_;
  const PoseSearch& options_;
  std::mt19937_64 random_;
};

}  // namespace

Vec3 middle_of(std::span<const Vec3> points) {
  Vec3 sum;
  for (const Vec3& p : points)
    sum += p;
  return points.empty() ? sum : sum * (1 / static_cast<double>(points.size()));
}

bool are_alike(const RigidMotion& a, const RigidMotion& b, const Vec3& middle, double degrees,
               double mm) {
  return degrees_between(a, b) <= degrees && length(a(middle) - b(middle)) <= mm;
}

std::vector<RigidMotion> candidate_poses(const SurfacePoints& from, const SurfacePoints& to,
                                         std::span<const FeatureMatch> matches,
                                         const PoseSearch& options) {
  std::vector<RigidMotion> poses;
  if (matches.size() < 3) return poses;
  Search search(from, to, matches, options);
  const Vec3 middle = middle_of(from.at);
  for (const auto& scored : search.triples()) {
    if (poses.size() >= options.candidates) break;
    const RigidMotion motion = search.motion_of(scored.triple);
    const bool is_known = std::ranges::any_of(poses, [&](const RigidMotion& pose) {
      return are_alike(pose, motion, middle, kAlikeDegrees, kAlikeReaches * options.reach);
    });
    if (!is_known) poses.push_back(motion);
  }
  return poses;
}

}  // namespace vitrine::acquisition
