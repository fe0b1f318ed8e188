// SPDX-License-Identifier: Apache-2.0
// A pinhole with the radial and tangential distortion of a real lens (Brown's model), at a place.
#pragma once

#include <optional>

#include "codec/core/vec.h"

namespace vitrine::rig {

struct Pixel {
  double u = 0, v = 0;  // (0, 0) is the centre of the top left pixel, v down
};

struct Lens {
  double focal = 0;           // pixels
  Pixel centre;               // where the optical axis meets the sensor
  double k1 = 0, k2 = 0;      // radial
  double p1 = 0, p2 = 0;      // tangential
  Vec3 at;                    // the pinhole, mm
  Vec3 right, down, forward;  // unit vectors
};

// Looks from `at` towards `target`, its v along the world's -z but for `roll` (radians).
void aim(Lens& lens, const Vec3& at, const Vec3& target, double roll);

// Nothing for points behind the lens. Pixels beyond the sensor are answered, too.
std::optional<Pixel> project(const Lens& lens, const Vec3& point);

// The unit direction of the light that reaches a pixel.
Vec3 ray(const Lens& lens, const Pixel& pixel);

}  // namespace vitrine::rig
