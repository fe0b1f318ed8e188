// SPDX-License-Identifier: Apache-2.0
// Runs the simulated rig inside this process. The pictures are the same as over GigE Vision and
// USB, and all intermediate results are accessible.
#pragma once

#include <memory>
#include <vector>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/profile/profile.h"
#include "acquisition/profile/stripe.h"
#include "acquisition/rig_optics/renderer.h"
#include "acquisition/rig_optics/solid.h"
#include "acquisition/rig_optics/stage.h"
#include "acquisition/session/live_scanner.h"
#include "support/product_names.h"

namespace vitrine::bench {

struct StripeAt {
  double angle = 0;  // angle commanded to the board, in degrees
  std::vector<StripePoint> points;
};

// Makes one profile of calibrated points for every `every`-th angle.
std::vector<Profile> profiles_of(const std::vector<StripeAt>& stripes,
                                 const Calibration& calibration, int every = 1);

// A simulated rig with one object on its table. Only one thread may use it. Throws on errors.
class SimulatedScanner {
 public:
  // Puts `object`, in mm, on the table.
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
