// SPDX-License-Identifier: Apache-2.0
// How good a calibration is, judged on pictures of the target that it was not fitted to.
#pragma once

#include <string>
#include <vector>

#include "acquisition/calibration/calibration.h"

namespace vitrine {

struct HeldOutPoint {
  double u = 0, v = 0;            // pixels
  double dx = 0, dy = 0, dw = 0;  // mm in the laser plane and out of it: measured minus predicted
  int pose = 0;

  double size() const;
};

struct DegreeResult {
  int degree = 0;
  double condition = 0;  // of the normalised equations
  ResidualSummary residuals;
};

struct Coverage {
  double image_share = 0;                               // of the picture within the map's hull
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  // mm of the laser plane, within the hull
};

struct CalibrationReport {
  int pictures = 0;
  std::size_t points = 0;     // of the stripe on the target
  std::size_t strays = 0;     // points on the target, too, but off the stripe: left out
  int unclear = 0;            // pictures left out: too many of their points were strays
  double reprojection = 0;    // pixels that the target's corners are off; 0 without pictures
  double table_error = 0;     // degrees, rms of the table's angles against the pictures
  ResidualSummary residuals;  // as the calibration has them
  Coverage coverage;
  std::vector<DegreeResult> degrees;
  std::vector<HeldOutPoint> held_out;

  double stray_share() const;
};

struct Calibrated {
  Calibration calibration;  // not numbered yet
  CalibrationReport report;
};

// One JSON object, without the single points.
std::string report_json(const Calibration& calibration, const CalibrationReport& report);

// A picture of the residuals over the image, as a self-contained SVG: arrows, enlarged.
std::string residual_plot(const Calibration& calibration, const CalibrationReport& report);

}  // namespace vitrine
