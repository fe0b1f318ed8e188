// SPDX-License-Identifier: Apache-2.0
// The exact calibration of the simulated rig, for tests that do not calibrate it themselves.
#pragma once

#include <vector>

#include "acquisition/calibration/calibration.h"
#include "acquisition/rig/rig_scanner.h"
#include "acquisition/rig_optics/renderer.h"

namespace vitrine::acquisition::rig::test {

// Returns the calibration of the rig with this seed. In the laser plane, x is the world's x, and y
// points up. The plane's origin is the foot of the perpendicular from the world's origin.
inline Calibration perfect_calibration(std::uint64_t seed) {
  const Optics optics = optics_of(seed);
  const Vec3 &normal = optics.laser.normal, up{0, -normal.z, normal.y};
  std::vector<Correspondence> points;
  for (double x = -10; x <= 45; x += 2.5) {
    for (double y = -5; y <= 60; y += 2.5) {
      const auto pixel =
          project(optics.camera, normal * optics.laser.offset + Vec3{1, 0, 0} * x + up * y);
      points.push_back({pixel->u, pixel->v, {x, y}});
    }
  }
  Calibration calibration;
  calibration.created = "2026-01-01T00:00:00Z";
  calibration.camera = camera_serial(seed);
  calibration.region = kWholeSensor;
  calibration.map = *PlaneMap::fit(points, 5, kSensorWidth, kSensorHeight);
  calibration.axis = {.offset = optics.laser.offset,
                      .tilt = -normal.z / normal.y,
                      .is_clockwise = optics.is_clockwise};
  return calibration;
}

}  // namespace vitrine::acquisition::rig::test
