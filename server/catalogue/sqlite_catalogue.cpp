// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sqlite_catalogue.h"

#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite_database.h"

namespace vitrine::server {

Expected<std::unique_ptr<Catalogue>> open_sqlite_catalogue(const std::filesystem::path& file) {
  return sqlite::open_database(file).map(make_catalogue);
}

Expected<std::unique_ptr<JobCatalogue>> open_sqlite_jobs(const std::filesystem::path& file) {
  return sqlite::open_database(file).map(make_jobs);
}

}  // namespace vitrine::server
