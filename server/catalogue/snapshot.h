// SPDX-License-Identifier: Apache-2.0
// Copies an SQLite database consistently while it is in use.
#pragma once

#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine::server {

// Copies the state that the SQLite database `from` has at one moment to the new file `to`, which
// only its owner can read. Other processes may use `from` during the copy. Fails with kIo.
Expected<void> snapshot_sqlite(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace vitrine::server
