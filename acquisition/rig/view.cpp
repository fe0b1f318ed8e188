// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/view.h"

namespace vitrine::rig {

View seen_from(const Placement& placement, const Optics& optics) {
  const auto direction = [&](const Vec3& v) {
    return Vec3{dot(v, placement.x), dot(v, placement.y), dot(v, placement.z)};
  };
  const auto point = [&](const Vec3& p) { return direction(p - placement.origin); };
  View view{optics.camera, optics.laser};
  view.camera.at = point(optics.camera.at);
  view.camera.right = direction(optics.camera.right);
  view.camera.down = direction(optics.camera.down);
  view.camera.forward = direction(optics.camera.forward);
  view.laser.normal = direction(optics.laser.normal);
  view.laser.offset = optics.laser.offset - dot(optics.laser.normal, placement.origin);
  view.laser.source = point(optics.laser.source);
  return view;
}

Placement on_table(const Optics& optics, double degrees, const Placement& at_zero) {
  return {turned(optics, degrees, at_zero.x), turned(optics, degrees, at_zero.y),
          turned(optics, degrees, at_zero.z), turned(optics, degrees, at_zero.origin)};
}

}  // namespace vitrine::rig
