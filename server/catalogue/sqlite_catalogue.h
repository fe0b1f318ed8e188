// SPDX-License-Identifier: Apache-2.0
// The catalogue with its jobs and scans in an SQLite file (WAL), which several processes may use at
// once.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"

namespace vitrine::server {

// Opens the database `file`, and creates or migrates its tables. The folder must exist. Fails with
// kIo if the file cannot be used. Fails with kUnsupported if a newer version of Vitrine has changed
// the tables and this version cannot use them.
Expected<std::unique_ptr<Catalogue>> open_sqlite_catalogue(const std::filesystem::path& file);

// Opens the jobs and scans in the same file over a separate connection, with the same errors.
Expected<std::unique_ptr<JobCatalogue>> open_sqlite_jobs(const std::filesystem::path& file);

}  // namespace vitrine::server
