// SPDX-License-Identifier: Apache-2.0
// Ensures that a scan is completed with the same calibration with which it was started.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/scan_request.h"

namespace vitrine::acquisition {

// Returns the SHA-256 of the calibration's contents as 64 hexadecimal digits. scan.json stores it
// with the calibration's number.
std::string digest_of(const Calibration& calibration);

// Checks the calibration. Fails with kBadInput if the calibration is for another camera or region.
Expected<void> fits(const Calibration& calibration, const std::string& camera,
                    const SensorRegion& region);

// Loads the calibration that `record` names from the folder `calibrations`. Fails with kIo if the
// calibration is missing. Fails with kBadInput if the calibration is for another camera or region.
// Also fails with kBadInput if the calibration differs from the one with which the scan started,
// because the file was edited or comes from another folder.
Expected<Calibration> calibration_of(const ScanRecord& record,
                                     const std::filesystem::path& calibrations);

}  // namespace vitrine::acquisition
