// SPDX-License-Identifier: Apache-2.0
// A calibration without a target, from what was measured by other means.
#pragma once

#include <string>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/session/scanner_config.h"

namespace vitrine::cli {

struct MeasuredFiles {
  std::string points;  // CSV, as read_correspondences() takes it
  std::string axis;    // JSON, as axis_from_json() takes it
};

// Asks the scanner's camera which one it is and what region it reads; turns nothing. Fails (kIo,
// kBadInput, kLimit) with file, place and what is expected there before a camera is looked for.
Expected<Calibrated> calibrate_by(const MeasuredFiles& files, const ScannerConfig& config,
                                  const CalibrationOptions& options);

}  // namespace vitrine::cli
