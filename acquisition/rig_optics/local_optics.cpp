// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/local_optics.h"

namespace vitrine::acquisition::rig {

LocalOptics optics_in(const SubjectFrame& frame, const Optics& optics) {
  const auto direction = [&](const Vec3& v) {
    return Vec3{dot(v, frame.x), dot(v, frame.y), dot(v, frame.z)};
  };
  const auto point = [&](const Vec3& p) { return direction(p - frame.origin); };
  LocalOptics local{optics.camera, optics.laser};
  local.camera.at = point(optics.camera.at);
  local.camera.right = direction(optics.camera.right);
  local.camera.down = direction(optics.camera.down);
  local.camera.forward = direction(optics.camera.forward);
  local.laser.normal = direction(optics.laser.normal);
  local.laser.offset = optics.laser.offset - dot(optics.laser.normal, frame.origin);
  local.laser.source = point(optics.laser.source);
  return local;
}

SubjectFrame on_table(const Optics& optics, double degrees, const SubjectFrame& at_zero) {
  return {turned(optics, degrees, at_zero.x), turned(optics, degrees, at_zero.y),
          turned(optics, degrees, at_zero.z), turned(optics, degrees, at_zero.origin)};
}

}  // namespace vitrine::acquisition::rig
