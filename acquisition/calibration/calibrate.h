// SPDX-License-Identifier: Apache-2.0
// Computes a calibration from pictures of the target on the table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/calibration/report.h"
#include "acquisition/calibration/target.h"

namespace vitrine::acquisition {

// One position of the table: the corners seen in the picture without laser, and the points of the
// laser's line seen in the picture with laser.
struct TargetPicture {
  // Pictures with the same placement differ only by the table's angle: the target was not touched
  // between them.
  int placement = 0;
  double angle = 0;  // the table's angle in degrees, as reported by the motor board
  TargetView view;
  // The laser's line, with points on and beside the target. Empty if no line is seen.
  std::vector<ImagePoint> stripe;
};

struct CalibrationInput {
  std::string camera;  // serial number
  SensorRegion region;
  CharucoTarget target;
  std::vector<TargetPicture> pictures;
};

struct CalibrationOptions {
  // Degree of the plane map, 2 to 5. 0 chooses the lowest degree that does well on held-out poses.
  int degree = 0;
  // The map extends this many pixels beyond the points at which the stripe was seen.
  double margin = 20;
};

// Computes the calibration of a camera that stands upright. The axis requires at least one
// placement that is seen at several angles of the table. For the map, the stripe on the target
// should cover the space that objects will fill. Fails with kBadInput if the pictures do not
// determine the calibration or contradict each other.
Expected<Calibrated> calibrate(const CalibrationInput& input, const CalibrationOptions& options);

// Computes a calibration without pictures, from a known axis and points with known coordinates in
// the laser plane. Fits the map to these points. `camera` and `region` have the same meaning as in
// CalibrationInput.
Expected<Calibrated> calibrate(std::span<const Correspondence> points, const TurntableAxis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options);

}  // namespace vitrine::acquisition
