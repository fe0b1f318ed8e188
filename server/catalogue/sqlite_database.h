// SPDX-License-Identifier: Apache-2.0
// The catalogue's database in an SQLite file (WAL), which several processes may use at once.
#pragma once

#include <filesystem>

#include "server/catalogue/sql.h"

namespace vitrine::server::sqlite {

// Opens the database `file`, and creates or migrates its tables. Makes a new file readable only for
// its owner, because it holds hashes of tokens, and drafts. The folder must exist. All threads
// share one connection, one at a time. Fails with kIo if the file cannot be used. Fails with
// kUnsupported if a newer version of Vitrine has changed the tables and this version cannot use
// them.
Expected<std::shared_ptr<sql::Database>> open_database(const std::filesystem::path& file);

// Returns an empty database in memory with the newest tables. Throws a Failure if memory runs out.
std::shared_ptr<sql::Database> newest_tables();

}  // namespace vitrine::server::sqlite
