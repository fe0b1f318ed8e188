// SPDX-License-Identifier: Apache-2.0
// What turns the pixels of one camera into millimetres about the table's axis. Never changed: a new
// one has a new number, and a scan names the one it used.
#pragma once

#include <string>

#include "acquisition/calibration/axis.h"
#include "acquisition/calibration/plane_map.h"
#include "acquisition/frame/frame.h"

namespace vitrine {

struct ResidualSummary {  // mm, over held-out poses
  double rms = 0, p95 = 0, max = 0;
};

struct Calibration {
  int number = 0;       // 1, 2, 3, … of one scanner
  std::string created;  // 2026-11-23T08:00:00Z
  std::string camera;   // serial
  SensorRegion region;
  PlaneMap map;
  Axis axis;
  ResidualSummary residuals;
  double noise = 0;  // mm: standard deviation of a stripe point across the stripe, as calibrated
};

}  // namespace vitrine
