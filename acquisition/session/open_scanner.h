// SPDX-License-Identifier: Apache-2.0
// Opens the physical devices of a scanner from its configuration.
#pragma once

#include "acquisition/session/scanner.h"
#include "acquisition/session/scanner_config.h"

namespace vitrine::acquisition {

// Returns the scanner of that configuration. The scanner opens a device only when a scan or a
// calibration needs it, and reopens a camera by its serial number.
Scanner open_scanner(const ScannerConfig& config);

}  // namespace vitrine::acquisition
