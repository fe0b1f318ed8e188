// SPDX-License-Identifier: Apache-2.0
// Checks an SQLite database for damage.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server::sqlite {

// Reads every page of the database `file`, and checks its structure, indices, references and
// schema. The check also finds changed values, because indices contain copies of all values except
// a job's progress, stage and lease. Returns at most 20 faults, each in one line; empty if there
// are none. Opens its own connection, so others may use the database at the same time. Fails with
// kIo if the database cannot be opened.
Expected<std::vector<std::string>> find_faults(const std::filesystem::path& file);

}  // namespace vitrine::server::sqlite
