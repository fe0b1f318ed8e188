// SPDX-License-Identifier: Apache-2.0
// Computes one point-to-plane step of registration. Such a step moves quickly along surfaces that
// are already in contact, where a point-to-point step is slow.
#pragma once

#include <span>

#include "codec/core/vec.h"
#include "codec/distance/rigid_alignment.h"

namespace vitrine::acquisition {

struct Counterpart {
  Vec3 point, on;  // a point, and the closest point on the other surface
  Vec3 normal;     // unit normal at the closest point
};

// Returns the small motion that brings the points closest to the tangent planes at their
// counterparts, by least squares ([CM92]). Returns the identity if the pairs do not determine the
// motion.
RigidMotion towards_planes(std::span<const Counterpart> pairs);

}  // namespace vitrine::acquisition
