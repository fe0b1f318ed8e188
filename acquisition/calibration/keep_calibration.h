// SPDX-License-Identifier: Apache-2.0
// A calibration with what is known of it: NNNN.json, NNNN.report.json and, of the residuals,
// NNNN.svg.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/report.h"
#include "codec/core/expected.h"

namespace vitrine {

std::filesystem::path report_file(const std::filesystem::path& folder, int number);
std::filesystem::path residuals_file(const std::filesystem::path& folder, int number);

// The share of the diagonal of what a calibration covers that its rms over held-out poses may be,
// for scanners of any size: points that do not belong together are off by tenths of the diagonal,
// and what is off by a hundredth shows no detail of an object.
inline constexpr double kLargestRms = .01;

// Writes all three into a folder of a CalibrationStore and returns the calibration with its number.
// Fails with kIo, and with kBadInput where its rms is larger than that: nothing is written then.
Expected<Calibration> keep_calibration(const std::filesystem::path& folder,
                                       const Calibrated& calibrated);

}  // namespace vitrine
