// SPDX-License-Identifier: Apache-2.0
// Camera and laser as a subject in its own frame sees them.
#pragma once

#include "acquisition/rig/optics.h"

namespace vitrine::rig {

// Of a subject's frame in the world: its unit vectors and its origin.
struct Placement {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;
};

struct View {
  Lens camera;
  LaserSheet laser;
};

View seen_from(const Placement& placement, const Optics& optics);

// Of what stands on the table at `degrees`.
Placement on_table(const Optics& optics, double degrees, const Placement& at_zero = {});

}  // namespace vitrine::rig
