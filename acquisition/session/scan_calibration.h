// SPDX-License-Identifier: Apache-2.0
// The calibration that a scan was begun with, and no other.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/calibration.h"
#include "acquisition/session/scan_request.h"

namespace vitrine {

// SHA-256 of all that it says, 64 hexadecimal digits: what scan.json names beside the number.
std::string digest_of(const Calibration& calibration);

// Fails (kBadInput) where it is not of that camera and region.
Expected<void> fits(const Calibration& calibration, const std::string& camera,
                    const SensorRegion& region);

// The one that `record` names, from the folder `calibrations`. Fails where it is missing (kIo), is
// of another camera or region, or is not what it was when the scan was begun (kBadInput): another
// folder, or a file that was changed.
Expected<Calibration> calibration_of(const ScanRecord& record,
                                     const std::filesystem::path& calibrations);

}  // namespace vitrine
