// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "acquisition/session/live_scanner.h"

namespace vitrine {

// The same devices, opened and commanded as long as `may` says so: its error is theirs. Whoever may
// not any more closes the board, which switches laser and motor off, and does nothing else to it.
ScannerDevices fenced(ScannerDevices devices, const std::function<Expected<void>()>& may);

}  // namespace vitrine
