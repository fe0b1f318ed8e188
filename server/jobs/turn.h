// SPDX-License-Identifier: Apache-2.0
// Which turn of the table a scan's folder holds. Who drives the scanner next may be another daemon,
// with a folder of its own, and the table does not stand where the first one has left it.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"

namespace vitrine {

// Whether that is what the folder holds: a ScanEntry::turn, empty where an earlier version has made
// the folder. kIo where it is there and cannot be read.
Expected<bool> holds_turn(const std::filesystem::path& folder, const std::string& turn);

// The folder, without what it held, for that turn.
Expected<void> begin_turn(const std::filesystem::path& folder, const std::string& turn);

}  // namespace vitrine
