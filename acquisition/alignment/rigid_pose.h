// SPDX-License-Identifier: Apache-2.0
// Inverse and difference of rigid motions.
#pragma once

#include "codec/distance/rigid_alignment.h"

namespace vitrine::acquisition {

// Rotates a direction by the rotation of `motion`, without its translation.
Vec3 turned(const RigidMotion& motion, const Vec3& direction);

RigidMotion inverse(const RigidMotion& motion);

// The angle, in degrees, by which two motions differ in their rotations, 0 to 180.
double degrees_between(const RigidMotion& a, const RigidMotion& b);

}  // namespace vitrine::acquisition
