// SPDX-License-Identifier: Apache-2.0
// How camera, laser and table stand to each other. World frame: mm, z the table's axis upwards, 0
// its top; at 0 degrees the object's frame is the world's.
#pragma once

#include <cstdint>

#include "acquisition/rig/lens.h"

namespace vitrine::rig {

inline constexpr int kSensorWidth = 1300, kSensorHeight = 1030;  // pixels

// A sheet of light: the points p with dot(normal, p) == offset, lit from `source` in it. It crosses
// the axis, or nearly so: what is missing is for a calibration to find.
struct LaserSheet {
  Vec3 normal{0, 1, 0};  // unit; its x is 0, so that the sheet meets the table along the x axis,
                         // but for the other laser's
  double offset = 0;     // mm
  Vec3 source;
  double sigma = 0.13;  // mm, of its profile across
};

struct Optics {
  Lens camera;
  LaserSheet laser;
  bool clockwise = false;  // how the table turns, seen from above, when its angle grows
};

// No two seeds give the same rig, so that no calibration fits another. Fixed for all of them: a 16
// mm lens on pixels of 5.3 um, at most 30 degrees between laser sheet and camera, an object of 80
// mm height and 45 mm radius wholly in view.
Optics optics_of(std::uint64_t seed);

// Of the laser that many scanners have on the camera's other side, at the same angle to it.
LaserSheet other_laser(const Optics& optics);

// Where a point of the object is when the table stands at `degrees`, and back.
Vec3 turned(const Optics& optics, double degrees, const Vec3& p);
Vec3 turned_back(const Optics& optics, double degrees, const Vec3& p);

}  // namespace vitrine::rig
