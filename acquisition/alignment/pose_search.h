// SPDX-License-Identifier: Apache-2.0
// Searches for the motions that could lay one scan on another, from matches of which most are
// wrong.
#pragma once

#include <span>
#include <vector>

#include "acquisition/alignment/point_features.h"
#include "codec/distance/rigid_alignment.h"

namespace vitrine::acquisition {

struct PoseSearch {
  double reach = 0;             // mm: matched points closer than this agree with a motion
  int trials = 1'000'000;       // triples of matches that are tried
  std::size_t candidates = 32;  // most motions to return
  std::uint64_t seed = 1;
};

// Returns motions of `from` onto `to` that agree with many matches, most matches first. Each is the
// motion of a random triple of matches ([FB81]) whose points have about the same distances from one
// another on both sides. Any two motions differ by more than 8 degrees or three times `reach`.
// Equal input and seed give an equal result.
std::vector<RigidMotion> candidate_poses(const SurfacePoints& from, const SurfacePoints& to,
                                         std::span<const FeatureMatch> matches,
                                         const PoseSearch& options);

// Returns whether two motions differ by at most `degrees` and `mm`. The distance is that of the
// moved point `middle`.
bool are_alike(const RigidMotion& a, const RigidMotion& b, const Vec3& middle, double degrees,
               double mm);

Vec3 middle_of(std::span<const Vec3> points);

}  // namespace vitrine::acquisition
