// SPDX-License-Identifier: Apache-2.0
// The simulated rig inside this process: the same pictures as by GigE Vision and USB, without
// either, and what lies between pictures and mesh in reach.
#pragma once

#include <memory>
#include <vector>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"
#include "acquisition/rig/renderer.h"
#include "acquisition/rig/solid.h"
#include "acquisition/rig/stage.h"
#include "acquisition/session/live_scanner.h"

namespace vitrine::bench {

struct StripeAt {
  double angle = 0;  // degrees, as the board was told
  std::vector<StripePoint> points;
};

// Of calibrated points, a profile an angle; every `every`-th.
std::vector<Profile> profiles_of(const std::vector<StripeAt>& stripes,
                                 const Calibration& calibration, int every = 1);

// One at a time; faults throw.
class SimulatedScanner {
 public:
  // `object` in mm, on the table.
  SimulatedScanner(const TriangleMesh& object, const rig::Realism& realism);

  CalibrationInput picture_target();
  FramePair pictures(double angle, double exposure_us = rig::kExposureUs);
  std::vector<StripeAt> scan(int steps, double exposure_us = rig::kExposureUs);

 private:
  rig::Solid solid_;
  rig::Stage stage_;
  rig::Renderer renderer_;
};

Calibration calibration_of(const CalibrationInput& input, int degree = 0);

}  // namespace vitrine::bench
