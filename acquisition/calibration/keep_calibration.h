// SPDX-License-Identifier: Apache-2.0
// Stores a calibration (NNNN.json) with its report (NNNN.report.json) and a plot of its residuals
// (NNNN.svg).
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/report.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

std::filesystem::path report_file(const std::filesystem::path& folder, int number);
std::filesystem::path residuals_file(const std::filesystem::path& folder, int number);

// Largest accepted rms over held-out poses, as a fraction of the diagonal of the calibrated area. A
// fraction suits scanners of any size. Wrongly matched points are off by tenths of the diagonal; an
// error of a hundredth already hides all detail of an object.
inline constexpr double kLargestRms = .01;

// Writes all three files into the folder of a CalibrationStore and returns the calibration with its
// number. Fails with kIo. If the rms exceeds kLargestRms, fails with kBadInput and writes no file.
Expected<Calibration> keep_calibration(const std::filesystem::path& folder,
                                       const Calibrated& calibrated);

}  // namespace vitrine::acquisition
