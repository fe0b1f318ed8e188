// SPDX-License-Identifier: Apache-2.0
#include "conformance/catalogue_suite.h"
#include "conformance/jobs_suite.h"
#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "support/process/postgres_server.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

class Postgres final : public CatalogueBackend {
 public:
  std::unique_ptr<Catalogue> connect() override {
    return make_catalogue(postgres::open_database(database_).value().database);
  }
  std::unique_ptr<NoteCatalogue> connect_notes() override {
    return make_notes(postgres::open_database(database_).value().database);
  }
  std::unique_ptr<VisitCatalogue> connect_visits() override {
    return make_visits(postgres::open_database(database_).value().database);
  }

 private:
  const std::string database_ = new_database();
};

class PostgresJobs final : public JobsBackend {
 public:
  std::unique_ptr<JobCatalogue> connect() override {
    return make_jobs(postgres::open_database(database_).value().database);
  }
  std::unique_ptr<Catalogue> connect_models() override {
    return make_catalogue(postgres::open_database(database_).value().database);
  }

 private:
  const std::string database_ = new_database();
};

}  // namespace

std::unique_ptr<CatalogueBackend> make_catalogue_backend() {
  return std::make_unique<Postgres>();
}

std::unique_ptr<JobsBackend> make_jobs_backend() {
  return std::make_unique<PostgresJobs>();
}

}  // namespace vitrine::test
