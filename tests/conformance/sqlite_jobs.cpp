// SPDX-License-Identifier: Apache-2.0
#include "conformance/jobs_suite.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class Sqlite final : public JobsBackend {
 public:
  std::unique_ptr<JobCatalogue> connect() override {
    return open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
  }
  std::unique_ptr<Catalogue> connect_models() override {
    return open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace

std::unique_ptr<JobsBackend> make_jobs_backend() {
  return std::make_unique<Sqlite>();
}

}  // namespace vitrine::test
