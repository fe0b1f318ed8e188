// SPDX-License-Identifier: Apache-2.0
// The catalogue in an SQLite file (WAL), which several processes may use at once.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {

// Opens the database `file`, and creates or migrates its tables. The folder must exist. Fails with
// kIo if the file cannot be used. Fails with kUnsupported if a newer version of Vitrine has changed
// the tables so that this version cannot use them.
Expected<std::unique_ptr<Catalogue>> open_sqlite_catalogue(const std::filesystem::path& file);

}  // namespace vitrine::server
