// SPDX-License-Identifier: Apache-2.0
// Searches for motions that may align one scan with another. Uses feature matches, most of which
// may be wrong.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/point_features.h"
#include "codec/distance/rigid_alignment.h"

namespace vitrine::acquisition {

struct PoseSearch {
  // Distance in mm. A match agrees with a motion if the motion brings its two points closer than
  // this, and their normals to within about 30 degrees.
  double reach = 0;
  int trials = 1'000'000;       // number of triples of matches to try
  std::size_t candidates = 32;  // largest number of motions to return
  std::uint64_t seed = 1;
};

// Returns motions from `from` to `to` that agree with many matches, sorted by the number of
// matches, the largest number first. Each motion comes from a random triple of matches ([FB81])
// whose points have about the same distances from each other in both scans. Any two motions differ
// by more than 8 degrees or by more than three times `reach`. Equal input and equal seeds give
// equal results.
std::vector<RigidMotion> candidate_poses(const SurfacePoints& from, const SurfacePoints& to,
                                         std::span<const FeatureMatch> matches,
                                         const PoseSearch& options);

// Returns whether two motions differ by at most `degrees` in rotation and by at most `mm` in the
// position to which they move the point `middle`.
bool are_alike(const RigidMotion& a, const RigidMotion& b, const Vec3& middle, double degrees,
               double mm);

Vec3 middle_of(std::span<const Vec3> points);

}  // namespace vitrine::acquisition
