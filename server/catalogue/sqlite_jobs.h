// SPDX-License-Identifier: Apache-2.0
// Jobs and scans in the SQLite file of the catalogue, over a connection of their own.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/jobs.h"

namespace vitrine {

// As open_sqlite_catalogue (sqlite_catalogue.h).
Expected<std::unique_ptr<JobCatalogue>> open_sqlite_jobs(const std::filesystem::path& file);

}  // namespace vitrine
