// SPDX-License-Identifier: Apache-2.0
// Aligns a surface with another surface by rotation and translation, using the iterative closest
// point algorithm [BM92].
#pragma once

#include <array>
#include <span>

#include "codec/core/vec.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {

struct RigidMotion {
  std::array<Vec3, 3> rows = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 shift;

  Vec3 operator()(const Vec3& p) const {
    return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + shift;
  }
};

// Returns the motion that applies `first`, then `second`.
RigidMotion then(const RigidMotion& first, const RigidMotion& second);

// Returns the motion of `from` that minimises the sum of squared distances between corresponding
// points [Horn87]. Both spans must have the same length.
RigidMotion fit_motion(std::span<const Vec3> from, std::span<const Vec3> to);

// Returns the motion that aligns `points` with `surface` [BM92]. The search starts from the points'
// current positions.
RigidMotion align(std::span<const Vec3> points, const TriangleBvh& surface);

}  // namespace vitrine::inline codec
