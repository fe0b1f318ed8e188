// SPDX-License-Identifier: Apache-2.0
// A pinhole camera at a position, with the radial and tangential lens distortion of [Brown71].
#pragma once

#include <optional>

#include "acquisition/frame/frame.h"
#include "codec/core/vec.h"

namespace vitrine::acquisition::rig {

struct Lens {
  double focal = 0;           // focal length, in pixels
  ImagePoint centre;          // the point at which the optical axis meets the sensor
  double k1 = 0, k2 = 0;      // radial distortion
  double p1 = 0, p2 = 0;      // tangential distortion
  Vec3 at;                    // position of the pinhole, mm
  Vec3 right, down, forward;  // unit vectors
};

// Places the lens at `at`, looking towards `target`. The picture's v axis points along the world's
// -z, rotated by `roll` radians.
void aim(Lens& lens, const Vec3& at, const Vec3& target, double roll);

// Projects a point. Returns nullopt if the point is behind the lens. The result may lie outside the
// sensor.
std::optional<ImagePoint> project(const Lens& lens, const Vec3& point);

// Returns the unit direction from the lens to the point that a pixel sees.
Vec3 ray(const Lens& lens, const ImagePoint& pixel);

}  // namespace vitrine::acquisition::rig
