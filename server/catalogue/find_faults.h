// SPDX-License-Identifier: Apache-2.0
// Checks the catalogue in a database for damage. Each function opens its own connection, so others
// may use the database at the same time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server {

namespace sqlite {

// Reads every page of the SQLite database `file`, and checks its structure, indices, references and
// schema. The check also finds changed values, because indices contain copies of all values except
// a job's progress, stage and lease. Returns at most 20 faults, each in one line; empty if there
// are none. Fails with kIo if the database cannot be opened.
Expected<std::vector<std::string>> find_faults(const std::filesystem::path& file);

}  // namespace sqlite

namespace postgres {

// Reads every row of the tables in the PostgreSQL database `url` (as for open_database()), so that
// the server checks its pages. Checks the references between the tables. Also checks the indices if
// the database has the extension amcheck and the user may call it. Returns the faults, each in one
// line; empty if there are none. Fails with kIo if the server is unreachable.
Expected<std::vector<std::string>> find_faults(const std::string& url);

}  // namespace postgres

}  // namespace vitrine::server
