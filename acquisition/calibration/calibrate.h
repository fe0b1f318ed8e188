// SPDX-License-Identifier: Apache-2.0
// From pictures of the target on the table to a calibration.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/calibration/report.h"
#include "acquisition/calibration/target.h"

namespace vitrine {

// One position of the table: what was seen without laser, and where the laser's line was then.
struct TargetPicture {
  int placement = 0;  // the same number: only the table moved, the target was not touched
  double angle = 0;   // degrees, of the table, as the board counts
  TargetView view;
  std::vector<Pixel> stripe;  // of the whole picture; empty where the laser misses the target
};

struct CalibrationInput {
  std::string camera;  // serial
  SensorRegion region;
  Target target;
  std::vector<TargetPicture> pictures;
};

struct CalibrationOptions {
  int degree = 3;      // of the plane map, 2 to 5; 0: the best by cross-validation
  double margin = 20;  // pixels around what the stripe was seen in where the map holds, too
};

// The camera stands upright. At least one placement is seen at several angles of the table, for its
// axis; the stripe on the target should fill what an object will fill, for the map. Fails
// (kBadInput) where the pictures do not determine the calibration, or contradict each other.
Expected<Calibrated> calibrate(const CalibrationInput& input, const CalibrationOptions& options);

// For scanners that were measured by other means: the map from points that are known in the laser
// plane. `camera` and `region` as above.
Expected<Calibrated> calibrate(std::span<const Correspondence> points, const Axis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options);

}  // namespace vitrine
