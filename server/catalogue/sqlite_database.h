// SPDX-License-Identifier: Apache-2.0
// The catalogue's database in an SQLite file (WAL): several processes may use it at once.
#pragma once

#include <filesystem>

#include "server/catalogue/sql.h"

namespace vitrine::sqlite {

// Creates or migrates it; one connection, which threads use one at a time. Fails with kIo where the
// file is refused, kUnsupported where a newer version of the software has tables that this one
// cannot go on with. The folder must exist.
Expected<std::shared_ptr<sql::Database>> open_database(const std::filesystem::path& file);

}  // namespace vitrine::sqlite
