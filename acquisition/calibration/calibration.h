// SPDX-License-Identifier: Apache-2.0
// A calibration maps the pixels of one camera to millimetres about the table's axis. A stored
// calibration never changes: a recalibration gets a new number, and a scan names the calibration
// that it used.
#pragma once

#include <string>

#include "acquisition/calibration/axis.h"
#include "acquisition/calibration/plane_map.h"
#include "acquisition/frame/frame.h"

namespace vitrine::acquisition {

struct ResidualSummary {  // residuals in mm, over poses left out of the fit
  double rms = 0, p95 = 0, max = 0;
};

struct Calibration {
  int number = 0;       // 1, 2, 3, …; unique for each scanner
  std::string created;  // UTC, such as 2026-11-23T08:00:00Z
  std::string camera;   // the camera's serial number
  SensorRegion region;
  PlaneMap map;
  TurntableAxis axis;
  ResidualSummary residuals;
  // Standard deviation of a stripe point across the stripe, in mm, measured at calibration.
  double noise = 0;
};

}  // namespace vitrine::acquisition
