// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_catalogue.h"

#include "server/catalogue/postgres_database.h"
#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sql_jobs.h"

namespace vitrine {

Expected<PostgresCatalogue> open_postgres_catalogue(const std::string& url) {
  const auto database = postgres::Database::open(url);
  if (!database) return Unexpected(database.error());
  return PostgresCatalogue{make_catalogue(*database), make_jobs(*database),
                           [database = *database] { return database->lock(); }};
}

}  // namespace vitrine
