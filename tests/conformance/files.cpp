// SPDX-License-Identifier: Apache-2.0
#include "conformance/object_store_suite.h"
#include "server/store/file_store.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class Files final : public ObjectStoreBackend {
 public:
  std::unique_ptr<ObjectStore> connect() override {
    return std::make_unique<FileStore>(FileStore::open(folder_.path() / "objects").value());
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace

std::unique_ptr<ObjectStoreBackend> make_object_store_backend() {
  return std::make_unique<Files>();
}

}  // namespace vitrine::test
