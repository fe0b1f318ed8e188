// SPDX-License-Identifier: Apache-2.0
// Camera and laser in the frame of a subject.
#pragma once

#include "acquisition/rig_optics/optics.h"

namespace vitrine::acquisition::rig {

// A subject's frame in world coordinates: its unit vectors, and its origin in mm.
struct SubjectFrame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;
};

struct LocalOptics {  // the optics in the subject's frame, mm
  Lens camera;
  LaserSheet laser;
};

// Converts the optics from the world to the subject's frame.
LocalOptics optics_in(const SubjectFrame& frame, const Optics& optics);

// Returns the frame of a subject that stands on the table, after the table has turned to `degrees`.
// `at_zero` is the subject's frame with the table at 0 degrees.
SubjectFrame on_table(const Optics& optics, double degrees, const SubjectFrame& at_zero = {});

}  // namespace vitrine::acquisition::rig
