// SPDX-License-Identifier: Apache-2.0
// Computes a calibration from pictures of the target on the table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/calibration/report.h"
#include "acquisition/calibration/target.h"

namespace vitrine::acquisition {

// Two pictures with the table at one angle: the corners come from the picture without laser, the
// laser's line from the picture with laser.
struct TargetPicture {
  // Number of the placement. The target was not touched between pictures of one placement; only the
  // table turned.
  int placement = 0;
  double angle = 0;  // the table's angle in degrees, as reported by the motor board
  TargetView view;
  // Points of the laser's line, on the target and outside it. Empty if no line was found.
  std::vector<ImagePoint> stripe;
};

struct CalibrationInput {
  std::string camera;  // serial number of the camera
  SensorRegion region;
  CharucoTarget target;
  std::vector<TargetPicture> pictures;
};

struct CalibrationOptions {
  // Degree of the plane map, 2 to 5. 0 chooses the lowest degree whose error on held-out poses is
  // close to the best.
  int degree = 0;
  // Margin, in pixels, by which the map extends beyond the points of the stripe.
  double margin = 20;
};

// Computes the calibration of a camera that stands upright. To find the axis, at least one
// placement must be seen at several angles of the table. The stripe on the target should cover the
// space in which objects will be scanned. Fails with kBadInput if the pictures do not determine the
// calibration or contradict each other.
Expected<Calibrated> calibrate(const CalibrationInput& input, const CalibrationOptions& options);

// Computes a calibration without pictures, from a known axis and points with known coordinates in
// the laser plane. Fits the map to these points. `camera` and `region` have the same meaning as in
// CalibrationInput.
Expected<Calibrated> calibrate(std::span<const Correspondence> points, const TurntableAxis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options);

}  // namespace vitrine::acquisition
