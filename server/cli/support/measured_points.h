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

// Calibrates a scanner from the files, which are checked first. Errors of this check (kIo,
// kBadInput or kLimit) name the file, the place and what is expected there. Asks the scanner's
// camera for its serial number and its region, but moves nothing.
Expected<acquisition::Calibrated> calibrate_by(const MeasuredFiles& files,
                                               const acquisition::ScannerConfig& config,
                                               const acquisition::CalibrationOptions& options);

}  // namespace vitrine::server::cli
