// SPDX-License-Identifier: Apache-2.0
// Calibrates a scanner from measured points, without a target.
#pragma once

#include <string>

#include "acquisition/calibration/calibrate.h"
#include "acquisition/session/scanner_config.h"

namespace vitrine::server::cli {

struct MeasuredFiles {
  std::string points;  // CSV in the format of read_correspondences()
  std::string axis;    // JSON in the format of axis_from_json()
};

// Checks the files and calibrates a scanner from them. Errors of the check (kIo, kBadInput or
// kLimit) name the file, the place in it and the expected content. Asks the scanner's camera for
// its serial number and its region, but moves nothing.
Expected<acquisition::Calibrated> calibrate_by(const MeasuredFiles& files,
                                               const acquisition::ScannerConfig& config,
                                               const acquisition::CalibrationOptions& options);

}  // namespace vitrine::server::cli
