// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "acquisition/session/scanner.h"
#include "acquisition/session/scanner_config.h"

namespace vitrine {

// The real devices that `config` names. Nothing is opened before a scan or a calibration needs it;
// a camera that has been opened once is looked for by its serial.
Scanner open_scanner(const ScannerConfig& config);

}  // namespace vitrine
