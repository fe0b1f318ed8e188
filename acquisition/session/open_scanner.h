// SPDX-License-Identifier: Apache-2.0
// Opens the real devices of a scanner from its configuration.
#pragma once

#include "acquisition/session/scanner.h"
#include "acquisition/session/scanner_config.h"

namespace vitrine::acquisition {

// Returns the scanner of that configuration. A device is opened only when a scan or a calibration
// needs it. A camera that was open before is found again by its serial number.
Scanner open_scanner(const ScannerConfig& config);

}  // namespace vitrine::acquisition
