// SPDX-License-Identifier: Apache-2.0
// The geometry of camera, laser and table, in mm in the world frame: z runs upwards along the
// table's axis and is 0 at the table's top. With the table at 0 degrees the object's frame equals
// the world frame.
#pragma once

#include <cstdint>

#include "acquisition/rig_optics/lens.h"

namespace vitrine::acquisition::rig {

inline constexpr int kSensorWidth = 1300, kSensorHeight = 1030;  // size of the sensor, in pixels

// A sheet of laser light: all points p with dot(normal, p) == offset, lit from `source`, which lies
// in the sheet. The sheet passes the table's axis at a small distance, which a calibration has to
// find.
struct LaserSheet {
  // A unit vector. Except for the second laser, its x is 0, so the sheet meets the table along the
  // x axis.
  Vec3 normal{0, 1, 0};
  double offset = 0;  // distance of the plane from the origin along `normal`, in mm
  Vec3 source;
  double sigma = 0.13;  // standard deviation of the sheet's cross section, in mm
};

struct Optics {
  Lens camera;
  LaserSheet laser;
  // Whether the table, seen from above, turns clockwise when its angle grows.
  bool is_clockwise = false;
};

// Returns the optics of a simulated scanner. Each seed gives another geometry, so a calibration
// fits only one seed. Each scanner has a 16 mm lens, pixels of 5.3 um and at most 30 degrees
// between laser sheet and camera. Its camera sees all of an object of 80 mm height and 45 mm
// radius.
Optics optics_of(std::uint64_t seed);

// Returns the second laser. As in many scanners, it is on the camera's other side at the same
// angle.
LaserSheet other_laser(const Optics& optics);

// turned() converts a point from the object's frame to the world frame, with the table at
// `degrees`. turned_back() does the opposite.
Vec3 turned(const Optics& optics, double degrees, const Vec3& p);
Vec3 turned_back(const Optics& optics, double degrees, const Vec3& p);

}  // namespace vitrine::acquisition::rig
