// SPDX-License-Identifier: Apache-2.0
// The catalogue in one SQLite file (WAL): several processes may use it at once.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/catalogue.h"

namespace vitrine {

// Creates or migrates the database. Fails with kIo where the file is refused, kUnsupported where a
// newer version of the software has tables that this one cannot go on with. The folder must exist.
Expected<std::unique_ptr<Catalogue>> open_sqlite_catalogue(const std::filesystem::path& file);

}  // namespace vitrine
