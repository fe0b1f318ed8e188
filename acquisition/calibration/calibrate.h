// SPDX-License-Identifier: Apache-2.0
// Computes a calibration from pictures of the target on the table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/calibration/report.h"
#include "acquisition/calibration/target.h"

namespace vitrine::acquisition {

// The pictures taken at one position of the table: the target in the picture without laser, and the
// laser's line on the target.
struct TargetPicture {
  // Pictures with the same placement differ only by the table's angle: the target was not touched
  // between them.
  int placement = 0;
  double angle = 0;  // degrees, as the board counts the table's angle
  TargetView view;
  // Pixels of the whole picture. Empty if the laser misses the target.
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

// Computes the calibration of a scanner that was measured by other means. Fits the map to points
// with known coordinates in the laser plane. `camera` and `region` have the same meaning as in
// CalibrationInput.
Expected<Calibrated> calibrate(std::span<const Correspondence> points, const TurntableAxis& axis,
                               const std::string& camera, const SensorRegion& region,
                               const CalibrationOptions& options);

}  // namespace vitrine::acquisition
