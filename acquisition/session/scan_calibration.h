// SPDX-License-Identifier: Apache-2.0
// Ensures that a scan is completed with the calibration it was started with.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/scan_request.h"

namespace vitrine::acquisition {

// Returns the SHA-256 of the calibration's contents as 64 hexadecimal digits. scan.json stores it
// with the calibration's number.
std::string digest_of(const Calibration& calibration);

// Fails with kBadInput if the calibration is not for that camera and region.
Expected<void> fits(const Calibration& calibration, const std::string& camera,
                    const SensorRegion& region);

// Loads the calibration that `record` names from the folder `calibrations`. Fails with kIo if the
// calibration is missing. Fails with kBadInput if it is for another camera or region, or differs
// from the one with which the scan started. The latter happens if the folder is another one or the
// file was edited.
Expected<Calibration> calibration_of(const ScanRecord& record,
                                     const std::filesystem::path& calibrations);

}  // namespace vitrine::acquisition
