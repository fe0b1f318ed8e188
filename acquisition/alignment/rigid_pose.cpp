// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/rigid_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrine::acquisition {

Vec3 turned(const RigidMotion& motion, const Vec3& direction) {
  return {dot(motion.rows[0], direction), dot(motion.rows[1], direction),
          dot(motion.rows[2], direction)};
}

RigidMotion inverse(const RigidMotion& motion) {
  const auto& [a, b, c] = motion.rows;
  RigidMotion back{{Vec3{a.x, b.x, c.x}, Vec3{a.y, b.y, c.y}, Vec3{a.z, b.z, c.z}}, {}};
  back.shift = turned(back, motion.shift) * -1;
  return back;
}

double degrees_between(const RigidMotion& a, const RigidMotion& b) {
  double trace = 0;
  for (std::size_t k = 0; k < 3; ++k)
    trace += dot(a.rows[k], b.rows[k]);
  return std::acos(std::clamp((trace - 1) / 2, -1., 1.)) * 180 / std::numbers::pi;
}

}  // namespace vitrine::acquisition
