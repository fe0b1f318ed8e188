// SPDX-License-Identifier: Apache-2.0
#include "conformance/catalogue_suite.h"
#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class Sqlite final : public CatalogueBackend {
 public:
  std::unique_ptr<Catalogue> connect() override {
    return open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  }
  std::unique_ptr<NoteCatalogue> connect_notes() override {
    return make_notes(server::sqlite::open_database(folder_.path() / "catalogue.sqlite").value());
  }
  std::unique_ptr<VisitCatalogue> connect_visits() override {
    return make_visits(server::sqlite::open_database(folder_.path() / "catalogue.sqlite").value());
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace

std::unique_ptr<CatalogueBackend> make_catalogue_backend() {
  return std::make_unique<Sqlite>();
}

}  // namespace vitrine::test
