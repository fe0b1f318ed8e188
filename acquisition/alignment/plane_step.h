// SPDX-License-Identifier: Apache-2.0
// Computes one point-to-plane step of registration. If surfaces are already in contact, such a step
// can slide them along each other quickly, whereas a point-to-point step is slow.
#pragma once

#include <span>

#include "codec/core/vec.h"
#include "codec/distance/rigid_alignment.h"

namespace vitrine::acquisition {

struct Counterpart {
  Vec3 point, on;  // a point, and the closest point on the other surface
  Vec3 normal;     // unit normal at the closest point
};

// Returns the small motion that minimises the sum of squared distances of the points from the
// tangent planes at their counterparts ([CM92]). Returns the identity if the pairs do not determine
// the motion.
RigidMotion towards_planes(std::span<const Counterpart> pairs);

}  // namespace vitrine::acquisition
