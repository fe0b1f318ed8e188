// SPDX-License-Identifier: Apache-2.0
// The quality of a calibration, measured on pictures of the target that were left out of the fit.
#pragma once

#include <string>
#include <vector>

#include "acquisition/calibration/calibration.h"

namespace vitrine::acquisition {

struct HeldOutPoint {
  double u = 0, v = 0;  // position of the point in the picture, in pixels
  // Residuals in mm, measured minus predicted: dx and dy in the laser plane, dw perpendicular to
  // it.
  double dx = 0, dy = 0, dw = 0;
  int pose = 0;

  double size() const;
};

struct DegreeResult {
  int degree = 0;
  double condition = 0;  // condition number of the fit (PlaneMap::condition())
  ResidualSummary residuals;
};

struct Coverage {
  double image_share = 0;  // share of the picture within the map's hull
  // Bounds, in the laser plane, of the points to which the map was fitted, in mm.
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
};

struct CalibrationReport {
  int pictures = 0;
  std::size_t points = 0;  // number of stripe points on the target
  // Number of points on the target that were left out because they are far from the stripe.
  std::size_t strays = 0;
  int unclear = 0;  // number of pictures left out because too many of their points were strays
  // Rms reprojection error of the target's corners, in pixels. 0 if there are no pictures.
  double reprojection = 0;
  // Rms difference, in degrees, between the angles that the table reports and the angles computed
  // from the pictures.
  double table_error = 0;
  ResidualSummary residuals;  // over the points in `held_out`
  Coverage coverage;
  std::vector<DegreeResult> degrees;
  std::vector<HeldOutPoint> held_out;

  double stray_share() const;
};

struct Calibrated {
  Calibration calibration;  // the result; its number is not set
  CalibrationReport report;
};

// Returns one JSON object, without the individual points.
std::string report_json(const Calibration& calibration, const CalibrationReport& report);

// Plots the residuals over the image as a self-contained SVG with enlarged arrows.
std::string residual_plot(const Calibration& calibration, const CalibrationReport& report);

}  // namespace vitrine::acquisition
