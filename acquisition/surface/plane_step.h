// SPDX-License-Identifier: Apache-2.0
// One step of registration by planes: it slides along what it already touches, which steps towards
// points do only slowly.
#pragma once

#include <span>

#include "codec/core/vec.h"
#include "codec/mesh/rigid_alignment.h"

namespace vitrine {

struct Counterpart {
  Vec3 point, on;  // a point and the closest one of the other surface
  Vec3 normal;     // there, of length 1
};

// The small motion that brings the points closest to the planes through their counterparts (least
// squares, Chen and Medioni 1992). None where they do not determine it.
RigidMotion towards_planes(std::span<const Counterpart> pairs);

// `second` after `first`.
RigidMotion then(const RigidMotion& first, const RigidMotion& second);

}  // namespace vitrine
