// SPDX-License-Identifier: Apache-2.0
// The jobs and scans in the catalogue's SQLite file, over a separate connection.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/jobs.h"

namespace vitrine::server {

// Opens the file as open_sqlite_catalogue() does, with the same errors.
Expected<std::unique_ptr<JobCatalogue>> open_sqlite_jobs(const std::filesystem::path& file);

}  // namespace vitrine::server
