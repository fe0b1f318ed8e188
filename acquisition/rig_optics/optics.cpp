// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/optics.h"

#include <cmath>
#include <numbers>

#include "acquisition/rig_optics/noise.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Returns the point at `distance` from `centre`, in the direction given by azimuth and elevation in
// degrees.
Vec3 around(const Vec3& centre, double distance, double azimuth, double elevation) {
  const double a = azimuth * kDegree, e = elevation * kDegree;
  return centre +
         Vec3{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)} * distance;
}

Vec3 turned_by(double radians, const Vec3& p) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

}  // namespace

Optics optics_of(std::uint64_t seed) {
  std::uint64_t drawn = 0;
  const auto about = [&](double mean, double spread) {
    return mean + spread * uniform(key_of(seed, 0x0b7c5, ++drawn));
  };
  Optics optics;
  Lens& camera = optics.camera;
  camera.focal = about(16 / 0.0053, 12);
  camera.centre = {about(kSensorWidth / 2.0, 9), about(kSensorHeight / 2.0, 7)};
  camera.k1 = about(-0.12, 0.02);
  camera.k2 = about(0.08, 0.03);
  camera.p1 = about(0, 4e-4);
  camera.p2 = about(0, 4e-4);
  const Vec3 middle{about(2, 1), about(0, 1), about(41, 0.7)};
  const double roll = about(0, 0.4) * kDegree;
  const double azimuth = about(-27.5, 1), elevation = about(9, 1);
  aim(camera, around(middle, about(345, 3), azimuth, elevation), middle, roll);

  LaserSheet& laser = optics.laser;
  const double tilt = about(0, 0.25) * kDegree;
  laser.normal = {0, std::cos(tilt), std::sin(tilt)};
  laser.offset = about(0, 0.3);
  laser.source = around({0, 0, 40}, about(340, 5), 0, about(16, 1));
  laser.source.y = (laser.offset - laser.normal.z * laser.source.z) / laser.normal.y;
  optics.is_clockwise = about(0, 1) < 0;
  return optics;
}

LaserSheet other_laser(const Optics& optics) {
  const double across = 2 * std::atan2(optics.camera.at.y, optics.camera.at.x);
  LaserSheet other = optics.laser;
  other.normal = turned_by(across, other.normal);
  other.source = turned_by(across, other.source);
  return other;
}

Vec3 turned(const Optics& optics, double degrees, const Vec3& p) {
  return turned_by((optics.is_clockwise ? -degrees : degrees) * kDegree, p);
}

Vec3 turned_back(const Optics& optics, double degrees, const Vec3& p) {
  return turned(optics, -degrees, p);
}

}  // namespace vitrine::acquisition::rig
