// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine {

// Copies the SQLite database `from` as it is at one moment, while others read and write it, to the
// new file `to`, which is for its owner alone. Fails (kIo) where either is refused.
Expected<void> snapshot_sqlite(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace vitrine
