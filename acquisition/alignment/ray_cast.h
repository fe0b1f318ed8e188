// SPDX-License-Identifier: Apache-2.0
// Intersects rays with a triangle mesh.
#pragma once

#include "codec/mesh/triangle_bvh.h"

namespace vitrine::acquisition {

// Returns whether the ray from `origin` hits a triangle. `direction` need not be a unit vector; all
// values must be finite.
bool hits(const TriangleBvh& surface, const Vec3& origin, const Vec3& direction);

}  // namespace vitrine::acquisition
