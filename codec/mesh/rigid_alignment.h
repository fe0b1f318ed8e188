// SPDX-License-Identifier: Apache-2.0
// Moves one surface onto another: iterated closest points, rotation and translation only.
#pragma once

#include <array>
#include <span>

#include "codec/core/vec.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine {

struct RigidMotion {
  std::array<Vec3, 3> rows = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 shift;

  Vec3 operator()(const Vec3& p) const {
    return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + shift;
  }
};

// The motion that brings `from` closest to `to` in the sense of least squares (Horn 1987). The
// spans are equally long.
RigidMotion fit_motion(std::span<const Vec3> from, std::span<const Vec3> to);

// The motion that brings `points` onto `surface`, starting from where they are.
RigidMotion align(std::span<const Vec3> points, const TriangleBvh& surface);

}  // namespace vitrine
