// SPDX-License-Identifier: Apache-2.0
// The catalogue, jobs and scans in a PostgreSQL database: any number of machines may use it at once.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"

namespace vitrine {

struct PostgresCatalogue {
  std::unique_ptr<Catalogue> catalogue;
  std::unique_ptr<JobCatalogue> jobs;
  // Is held by one at a time of all who use the database, until the result is gone.
  std::function<Expected<std::shared_ptr<const void>>()> lock;
};

// Creates or migrates the tables. `url`: postgresql://USER@HOST/DATABASE, with what else libpq
// knows. Fails with kIo where the server is not reached or refuses; no message tells the password.
Expected<PostgresCatalogue> open_postgres_catalogue(const std::string& url);

}  // namespace vitrine
