// SPDX-License-Identifier: Apache-2.0
// Wraps a scanner's devices so that they accept commands only while this daemon may command the
// scanner.
#pragma once

#include <functional>

#include "acquisition/session/live_scanner.h"

namespace vitrine::server {

// Returns wrappers of the devices, which call `may` before each command. If `may` returns an error,
// the command fails with that error and sends nothing to the device. The caller then closes the
// board, which switches laser and motor off.
acquisition::ScannerDevices fenced(acquisition::ScannerDevices devices,
                                   const std::function<Expected<void>()>& may);

}  // namespace vitrine::server
